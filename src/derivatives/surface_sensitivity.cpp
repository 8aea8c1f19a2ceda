#include "derivatives/surface_sensitivity.hpp"

#include <algorithm>

#include "partition/point_sums.hpp"

namespace alphadot {

namespace {

bool is_wall(BoundaryKind kind) {
  return kind == BoundaryKind::wall || kind == BoundaryKind::sting;
}

/// What is to be summed at a point over the ranks that know it.
struct PointPart {
  Vec3 derivative;
  Real area;  ///< of walls around it

  PointPart& operator+=(const PointPart& b) {
    derivative += b.derivative;
    area += b.area;
    return *this;
  }
};

/// This rank's, [points].
std::vector<PointPart> parts_of(const Discretization& discretization, std::span<const Vec3> by_points) {
  const Subdomain& domain = discretization.domain();
  std::vector<PointPart> out;
  out.reserve(by_points.size());
  for (const Vec3& derivative : by_points) out.push_back({derivative, 0});
  for (std::size_t i = 0; i < domain.boundary_faces.size(); ++i)
    if (const auto& face = domain.boundary_faces[i]; is_wall(discretization.kind_of(face)))
      for (const Index point : face.points)
        out[static_cast<std::size_t>(point)].area += norm(domain.boundary_normal[i]) / 3;
  return out;
}

}  // namespace

SurfaceSensitivity::SurfaceSensitivity(const Discretization& discretization, const Communicator& comm,
                                       std::span<const Vec3> by_points)
    : density_(discretization.domain().boundary_faces.size()) {
  const Subdomain& domain = discretization.domain();
  const auto ids = std::span(domain.point_ids).first(by_points.size());
  const auto sums = sum_at_points<PointPart>(ids, parts_of(discretization, by_points), comm);
  for (std::size_t face = 0; face < domain.boundary_faces.size(); ++face) {
    if (!is_wall(discretization.kind_of(domain.boundary_faces[face]))) continue;
    for (const Index point : domain.boundary_faces[face].points) {
      const auto& at = sums[static_cast<std::size_t>(point)];
      density_[face] += (1 / (3 * at.area)) * at.derivative;
    }
  }
  std::vector<Point> on_walls;
  for (std::size_t i = 0; i < sums.size(); ++i)
    if (sums[i].area > 0) on_walls.push_back({ids[i], domain.points[i], sums[i].derivative});
  points_ = deliver_to<Point>(
                on_walls, [](const Point&) { return 0; }, comm)
                .items;
  std::ranges::stable_sort(points_, {}, &Point::id);
  // A point has a copy of each rank that knows it.
  const auto is_copy = [](const Point& a, const Point& b) { return a.id == b.id; };
  points_.erase(std::unique(points_.begin(), points_.end(), is_copy), points_.end());
}

}  // namespace alphadot
