#include "derivatives/surface_sensitivity.hpp"

namespace alphadot {

namespace {

bool is_wall(BoundaryKind kind) {
  return kind == BoundaryKind::wall || kind == BoundaryKind::sting;
}

constexpr std::size_t numbers = 4;  // a point: derivative, area of walls around it

}  // namespace

SurfaceSensitivity::SurfaceSensitivity(const Discretization& discretization, const Communicator& comm,
                                       std::span<const Vec3> by_points)
    : density_(discretization.domain().boundary_faces.size()) {
  const Subdomain& domain = discretization.domain();
  std::vector<Real> all(numbers * static_cast<std::size_t>(domain.global_points), 0);
  const auto at = [&](Index point) {
    return &all[numbers * static_cast<std::size_t>(domain.point_ids[point])];
  };
  for (std::size_t point = 0; point < by_points.size(); ++point)
    for (int axis = 0; axis < 3; ++axis) at(static_cast<Index>(point))[axis] += by_points[point][axis];
  for (std::size_t face = 0; face < domain.boundary_faces.size(); ++face)
    if (is_wall(discretization.kind_of(domain.boundary_faces[face])))
      for (const Index point : domain.boundary_faces[face].points)
        at(point)[3] += norm(domain.boundary_normal[face]) / 3;
  comm.sum(all);
  for (std::size_t face = 0; face < domain.boundary_faces.size(); ++face) {
    if (!is_wall(discretization.kind_of(domain.boundary_faces[face]))) continue;
    for (const Index point : domain.boundary_faces[face].points) {
      const Real* n = at(point);
      density_[face] += (1 / (3 * n[3])) * Vec3{n[0], n[1], n[2]};
    }
  }
  // A place is a mean over the ranks that know it, which all say the same.
  std::vector<Real> places(numbers * static_cast<std::size_t>(domain.global_points), 0);
  for (Index point = 0; point < domain.owned_points; ++point) {
    if (at(point)[3] == 0) continue;
    Real* place = &places[numbers * static_cast<std::size_t>(domain.point_ids[point])];
    for (int axis = 0; axis < 3; ++axis) place[axis] = domain.points[point][axis];
    place[3] = 1;
  }
  comm.sum(places);
  if (!comm.is_root()) return;
  for (std::size_t id = 0; id < static_cast<std::size_t>(domain.global_points); ++id) {
    const Real* place = &places[numbers * id];
    if (place[3] == 0) continue;
    const Real* n = &all[numbers * id];
    points_.push_back({static_cast<GlobalIndex>(id),
                       (1 / place[3]) * Vec3{place[0], place[1], place[2]},
                       {n[0], n[1], n[2]}});
  }
}

}  // namespace alphadot
