#include "partition/geometry.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

namespace alphadot {

namespace {

/// Sorts the corners by id; true when an odd number of swaps did so.
template <std::size_t n>
bool sort_corners(std::array<Vec3, n>& points, std::array<GlobalIndex, n>& ids) {
  bool odd = false;
  for (std::size_t i = 1; i < n; ++i)
    for (std::size_t j = i; j > 0 && ids[j] < ids[j - 1]; --j) {
      std::swap(ids[j], ids[j - 1]);
      std::swap(points[j], points[j - 1]);
      odd = !odd;
    }
  return odd;
}

}  // namespace

// Never inlined: a copy in a loop may be given other fused multiply-adds than the next copy, and differ in
// the last bit.
[[gnu::noinline]] TriangleMetrics triangle_metrics(std::array<Vec3, 3> points,
                                                   std::array<GlobalIndex, 3> ids) {
  const bool odd = sort_corners(points, ids);
  const auto& [a, b, c] = points;
  return {(odd ? -0.5 : 0.5) * cross(b - a, c - a), (1.0 / 3) * (a + b + c)};
}

[[gnu::noinline]] TetrahedronMetrics tetrahedron_metrics(std::array<Vec3, 4> points,
                                                         std::array<GlobalIndex, 4> ids) {
  const bool odd = sort_corners(points, ids);
  const auto& [a, b, c, d] = points;
  return {(odd ? -1.0 : 1.0) / 6 * dot(cross(b - a, c - a), d - a), 0.25 * (a + b + c + d)};
}

[[gnu::noinline]] TetrahedronShape tetrahedron_shape(std::array<Vec3, 4> points,
                                                     std::array<GlobalIndex, 4> ids) {
  sort_corners(points, ids);
  std::array<Vec3, 4> normal;  // of the face opposite each corner; all outward or all inward
  Real largest_area = 0, longest_edge = 0;
  for (std::size_t face = 0; face < 4; ++face) {
    const auto& [i, j, k] = tetrahedron_faces[face];
    const Vec3 area = 0.5 * cross(points[j] - points[i], points[k] - points[i]);
    largest_area = std::max(largest_area, norm(area));
    normal[face] = (1 / norm(area)) * area;
  }
  Real cosine = -1;
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t j = 0; j < i; ++j) {
      cosine = std::max(cosine, -dot(normal[i], normal[j]));
      longest_edge = std::max(longest_edge, norm(points[i] - points[j]));
    }
  const Real volume =
      std::abs(dot(cross(points[1] - points[0], points[2] - points[0]), points[3] - points[0])) / 6;
  return {std::acos(std::min(cosine, 1.0)) / radians_per_degree,
          std::sqrt(2.0 / 3) * longest_edge * largest_area / (3 * volume)};
}

}  // namespace alphadot
