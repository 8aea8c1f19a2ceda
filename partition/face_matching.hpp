// Finds the cells and boundary triangles that share a face, in time proportional to their number.
#pragma once

#include <algorithm>
#include <array>
#include <compare>
#include <cstddef>
#include <span>
#include <vector>

#include "core/types.hpp"
#include "partition/geometry.hpp"

namespace alphadot {

/// The most cells whose 4 faces each, with as many triangles at most, can be numbered by an Index.
inline constexpr GlobalIndex max_cells_for_faces = GlobalIndex{1} << 28;

/// The face of `cells` opposite corner `side % 4` of cell `side / 4`, right-handed about the outward normal.
template <class PointId>
std::array<PointId, 3> side_points(std::span<const std::array<PointId, 4>> cells, Index side) {
  const auto& cell = cells[side / 4];
  const auto& corners = tetrahedron_faces[side % 4];
  return {cell[corners[0]], cell[corners[1]], cell[corners[2]]};
}

/// Calls `visit(std::span<const Index> sides)` once for each distinct face, with every side that has its
/// three points, ascending. Side s < 4 * cells.size() is the face of cell s / 4 opposite its corner s % 4;
/// the sides after those are the `triangles`. In a sound mesh each face has two sides. Faces come in the
/// order of their smallest point. Ids are in [0, point_count); at most max_cells_for_faces cells and
/// triangles each. Memory: 4 bytes a side and a point.
template <class PointId, class Visit>
void for_each_face(std::span<const std::array<PointId, 4>> cells,
                   std::span<const std::array<PointId, 3>> triangles, std::size_t point_count,
                   Visit&& visit) {
  const Index cell_sides = 4 * static_cast<Index>(cells.size());
  const Index side_count = cell_sides + static_cast<Index>(triangles.size());
  const auto points_of = [&](Index side) {
    return side < cell_sides ? side_points(cells, side) : triangles[side - cell_sides];
  };
  const auto smallest = [&](Index side) {
    const auto points = points_of(side);
    return static_cast<std::size_t>(std::min({points[0], points[1], points[2]}));
  };

  // Counting sort of the sides by their smallest point; begin[p] ends up at the first side of point p.
  std::vector<Index> begin(point_count + 1, 0);
  for (Index side = 0; side < side_count; ++side) ++begin[smallest(side)];
  for (std::size_t p = 1; p <= point_count; ++p) begin[p] += begin[p - 1];
  std::vector<Index> sides(static_cast<std::size_t>(side_count));
  for (Index side = side_count - 1; side >= 0; --side) sides[--begin[smallest(side)]] = side;

  // Sides of one point, about two dozen, by their other two points.
  struct Key {
    PointId middle, largest;
    Index side;
    auto operator<=>(const Key&) const = default;
    bool same_face(const Key& other) const { return middle == other.middle && largest == other.largest; }
  };
  std::vector<Key> keys;
  std::vector<Index> face;
  for (std::size_t p = 0; p < point_count; ++p) {
    keys.clear();
    for (Index i = begin[p]; i < begin[p + 1]; ++i) {
      const Index side = sides[i];
      auto points = points_of(side);
      std::sort(points.begin(), points.end());
      keys.push_back({points[1], points[2], side});
    }
    std::sort(keys.begin(), keys.end());
    for (std::size_t first = 0, last = 0; first < keys.size(); first = last) {
      face.clear();
      for (; last < keys.size() && keys[last].same_face(keys[first]); ++last) face.push_back(keys[last].side);
      visit(std::span<const Index>(face));
    }
  }
}

}  // namespace alphadot
