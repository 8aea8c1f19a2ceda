// The graph of cells joined by faces.
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "core/types.hpp"
#include "partition/adjacency.hpp"

namespace alphadot {

/// Cells that share a face with each cell, in the order of the cell's faces. `point_count`: ids are below it.
/// Cells may be local or global; a face with other than two cells joins none.
Adjacency dual_graph(std::span<const std::array<Index, 4>> cells, std::size_t point_count);
Adjacency dual_graph(std::span<const std::array<GlobalIndex, 4>> cells, std::size_t point_count);

}  // namespace alphadot
