#include "space/forces.hpp"

#include "space/turned_walls.hpp"

namespace alphadot {

std::vector<Real> numbers_of(std::span<const Load> loads) {
  std::vector<Real> out;
  out.reserve(6 * loads.size());
  for (const Load& load : loads)
    for (const Vec3& part : {load.force, load.moment}) out.insert(out.end(), {part.x, part.y, part.z});
  return out;
}

std::vector<Load> loads_of(std::span<const Real> numbers) {
  std::vector<Load> out;
  for (auto n = numbers.begin(); n != numbers.end(); n += 6)
    out.push_back({{n[0], n[1], n[2]}, {n[3], n[4], n[5]}});
  return out;
}

Load total_of(std::span<const Load> loads) {
  Load out;
  for (const Load& load : loads) out += load;
  return out;
}

std::vector<Real> excess_pressures(const Discretization& discretization, const Residual& residual) {
  std::vector<Real> excess(residual.boundary_pressures().begin(), residual.boundary_pressures().end());
  for (Real& pressure : excess) pressure -= 1 / discretization.gamma();
  return excess;
}

std::vector<Load> face_loads(const Discretization& discretization, std::span<const Real> excess_pressures,
                             const Vec3& center) {
  const Subdomain& domain = discretization.domain();
  std::vector<Load> out(domain.boundary_faces.size());
  const auto set_load = [&](std::size_t i, const Vec3& area, const Vec3& at) {
    if (discretization.kind_of(domain.boundary_faces[i]) != BoundaryKind::wall) return;
    const Vec3 force = excess_pressures[i] * area;
    out[i] = {force, cross(at - center, force)};
  };
  for (std::size_t i = 0; i < out.size(); ++i)
    set_load(i, domain.boundary_normal[i], domain.boundary_center[i]);
  for (const TurnedWall& wall : discretization.turned_walls()) {
    const auto [area, normal, at] = turned_geometry(domain, wall);
    set_load(static_cast<std::size_t>(wall.face), area * normal, at);
  }
  return out;
}

std::vector<Load> patch_loads(const Discretization& discretization, std::span<const Load> of_faces) {
  const Subdomain& domain = discretization.domain();
  std::vector<Load> out(domain.patch_names.size());
  for (std::size_t i = 0; i < of_faces.size(); ++i) out[domain.boundary_faces[i].patch] += of_faces[i];
  return out;
}

std::vector<Load> wall_loads(const Discretization& discretization, std::span<const Real> excess_pressures,
                             const Vec3& center) {
  return patch_loads(discretization, face_loads(discretization, excess_pressures, center));
}

std::vector<Load> wall_loads(const Discretization& discretization, const Residual& residual,
                             const Vec3& center) {
  return wall_loads(discretization, excess_pressures(discretization, residual), center);
}

}  // namespace alphadot
