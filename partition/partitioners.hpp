// The libraries that cut graphs, behind one signature each. For decompose.cpp.
#pragma once

#include <vector>

#include "core/communicator.hpp"
#include "partition/adjacency.hpp"

namespace alphadot {

/// The part of every vertex; parts at most 1 % above the mean. Throws InputError when METIS fails.
///
/// Cells count alike, at the boundary too: profiled over a steady solve, a boundary face takes as long as an
/// interior one, which is shared by two cells, and a cell with one therefore 3 % more than others. A rank
/// with a fifth more boundary faces than the mean has 0.1 % more work, less than the parts' own tolerance.
std::vector<int> metis_k_way(Adjacency& graph, int parts);

/// A graph spread over the ranks: rank r holds the rows of the r-th stretch of consecutive vertices.
struct DistributedGraph {
  std::vector<GlobalIndex> begin{0};
  std::vector<GlobalIndex> items;  ///< global ids of the neighbours
};

/// The part of every vertex of this rank. Collective. Throws InputError on all ranks when PT-Scotch fails.
std::vector<int> ptscotch_k_way(DistributedGraph& graph, int parts, const Communicator& comm);

}  // namespace alphadot
