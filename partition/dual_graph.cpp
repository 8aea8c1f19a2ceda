#include "partition/dual_graph.hpp"

#include <vector>

#include "partition/face_matching.hpp"

namespace alphadot {

namespace {

template <class PointId>
Adjacency build(std::span<const std::array<PointId, 4>> cells, std::size_t point_count) {
  std::vector<Index> across(4 * cells.size(), -1);  // the cell across each side
  for_each_face(cells, {}, point_count, [&](std::span<const Index> sides) {
    if (sides.size() != 2) return;
    across[sides[0]] = sides[1] / 4;
    across[sides[1]] = sides[0] / 4;
  });

  // Close the gaps in place: rows only move down.
  Adjacency graph;
  graph.begin.reserve(cells.size() + 1);
  std::size_t end = 0;
  for (std::size_t side = 0; side < across.size(); ++side) {
    if (across[side] >= 0) across[end++] = across[side];
    if (side % 4 == 3) graph.begin.push_back(static_cast<Index>(end));
  }
  across.resize(end);
  graph.items = std::move(across);
  return graph;
}

}  // namespace

Adjacency dual_graph(std::span<const std::array<Index, 4>> cells, std::size_t point_count) {
  return build(cells, point_count);
}

Adjacency dual_graph(std::span<const std::array<GlobalIndex, 4>> cells, std::size_t point_count) {
  return build(cells, point_count);
}

}  // namespace alphadot
