#include "march/turning.hpp"

#include <algorithm>

#include "motion/motion.hpp"
#include "space/face_geometry.hpp"

namespace alphadot {

std::vector<TurnedWall> turned_further(const Discretization& discretization,
                                       std::span<const std::string> patches, const Hinge& hinge, Real angle,
                                       Real rate) {
  const Subdomain& domain = discretization.domain();
  const auto turns = [&](std::size_t i) {
    const auto& face = domain.boundary_faces[i];
    const BoundaryKind kind = discretization.kind_of(face);
    return (kind == BoundaryKind::wall || kind == BoundaryKind::sting) &&
           std::ranges::find(patches, domain.patch_names[static_cast<std::size_t>(face.patch)]) !=
               patches.end();
  };
  const Vec3 about = -angle * hinge.axis;  // turns the axes back, and so the vectors
  std::vector<TurnedWall> out;
  auto before = discretization.turned_walls().begin();
  for (std::size_t i = 0; i < domain.boundary_faces.size(); ++i) {
    const bool has_turned =
        before != discretization.turned_walls().end() && before->face == static_cast<Index>(i);
    TurnedWall wall{static_cast<Index>(i), boundary_geometry(domain, i).normal, {}};
    if (has_turned) wall = *before++;
    const bool turns_now = turns(i);
    if (turns_now) {
      const Vec3 center = domain.boundary_center[i];
      const Vec3 arm = on_turned_axes(center + wall.shift - hinge.point, about);
      wall.normal = on_turned_axes(wall.normal, about);
      wall.shift = hinge.point + arm - center;
      wall.speed += rate * dot(cross(hinge.axis, arm), wall.normal);
    }
    if (has_turned || turns_now) out.push_back(wall);
  }
  return out;
}

}  // namespace alphadot
