#include "derivatives/surface_sensitivity.hpp"

#include <algorithm>
#include <numeric>

#include "partition/delivery.hpp"

namespace alphadot {

namespace {

bool is_wall(BoundaryKind kind) {
  return kind == BoundaryKind::wall || kind == BoundaryKind::sting;
}

/// A point of the mesh with what is to be summed over the ranks that know it.
struct PointPart {
  SurfaceSensitivity::Point point;
  Real area;  ///< of walls around it
};

/// This rank's, [points].
std::vector<PointPart> parts_of(const Discretization& discretization, std::span<const Vec3> by_points) {
  const Subdomain& domain = discretization.domain();
  std::vector<PointPart> out;
  out.reserve(by_points.size());
  for (std::size_t i = 0; i < by_points.size(); ++i)
    out.push_back({{domain.point_ids[i], domain.points[static_cast<Index>(i)], by_points[i]}, 0});
  for (std::size_t i = 0; i < domain.boundary_faces.size(); ++i)
    if (const auto& face = domain.boundary_faces[i]; is_wall(discretization.kind_of(face)))
      for (const Index point : face.points)
        out[static_cast<std::size_t>(point)].area += norm(domain.boundary_normal[i]) / 3;
  return out;
}

/// Replaces parts by sums over ranks. Every point has a rank where they are made. Returns those on walls that
/// this rank has made, each once.
std::vector<SurfaceSensitivity::Point> sum_over_ranks(std::vector<PointPart>& parts,
                                                      const Communicator& comm) {
  const auto addressed = address(
      parts.size(), [&](std::size_t i) { return static_cast<int>(parts[i].point.id % comm.size()); }, comm);
  std::vector<PointPart> sent;
  sent.reserve(parts.size());
  for (const Index i : addressed.order) sent.push_back(parts[static_cast<std::size_t>(i)]);
  auto [here, counts] = deliver<PointPart>(sent, addressed.counts, comm);
  std::vector<std::size_t> order(here.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, {}, [&](std::size_t i) { return here[i].point.id; });
  std::vector<SurfaceSensitivity::Point> made;
  for (auto first = order.begin(); first != order.end();) {
    auto total = here[*first];
    auto last = first + 1;
    for (; last != order.end() && here[*last].point.id == total.point.id; ++last) {
      total.point.derivative += here[*last].point.derivative;
      total.area += here[*last].area;
    }
    for (; first != last; ++first) here[*first] = total;
    if (total.area > 0) made.push_back(total.point);
  }
  const auto answers = deliver<PointPart>(here, counts, comm).items;
  for (std::size_t i = 0; i < answers.size(); ++i)
    parts[static_cast<std::size_t>(addressed.order[i])] = answers[i];
  return made;
}

}  // namespace

SurfaceSensitivity::SurfaceSensitivity(const Discretization& discretization, const Communicator& comm,
                                       std::span<const Vec3> by_points)
    : density_(discretization.domain().boundary_faces.size()) {
  const Subdomain& domain = discretization.domain();
  auto parts = parts_of(discretization, by_points);
  const auto made = sum_over_ranks(parts, comm);
  for (std::size_t face = 0; face < domain.boundary_faces.size(); ++face) {
    if (!is_wall(discretization.kind_of(domain.boundary_faces[face]))) continue;
    for (const Index point : domain.boundary_faces[face].points) {
      const auto& [at, area] = parts[static_cast<std::size_t>(point)];
      density_[face] += (1 / (3 * area)) * at.derivative;
    }
  }
  points_ = deliver_to<Point>(
                made, [](const Point&) { return 0; }, comm)
                .items;
  std::ranges::sort(points_, {}, &Point::id);
}

}  // namespace alphadot
