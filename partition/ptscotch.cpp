#include <mpi.h>

#include <ptscotch.h>

#include <cstdio>
#include <memory>

#include "core/error.hpp"
#include "partition/partitioners.hpp"

namespace alphadot {

static_assert(sizeof(SCOTCH_Num) == sizeof(GlobalIndex), "PT-Scotch is built with another index width");

std::vector<int> ptscotch_k_way(DistributedGraph& graph, int parts, const Communicator& comm) {
  constexpr double imbalance = 0.01;
  const auto vertices = static_cast<SCOTCH_Num>(graph.begin.size()) - 1;
  const auto edges = static_cast<SCOTCH_Num>(graph.items.size());
  std::vector<SCOTCH_Num> part(static_cast<std::size_t>(vertices) + 1);
  SCOTCH_randomReset();

  SCOTCH_Dgraph handle;
  SCOTCH_Strat strategy;
  bool failed = SCOTCH_dgraphInit(&handle, comm.handle()) != 0;
  const std::unique_ptr<SCOTCH_Dgraph, decltype(&SCOTCH_dgraphExit)> graph_end(&handle, SCOTCH_dgraphExit);
  failed |= SCOTCH_stratInit(&strategy) != 0;
  const std::unique_ptr<SCOTCH_Strat, decltype(&SCOTCH_stratExit)> strategy_end(&strategy, SCOTCH_stratExit);
  failed |= SCOTCH_stratDgraphMapBuild(&strategy, SCOTCH_STRATQUALITY, comm.size(), parts, imbalance) != 0;
  // Every call below is collective: all ranks make it or none.
  failed = comm.any(failed) ||
           comm.any(SCOTCH_dgraphBuild(&handle, 0, vertices, vertices, graph.begin.data(),
                                       graph.begin.data() + 1, nullptr, nullptr, edges, edges,
                                       graph.items.data(), nullptr, nullptr) != 0) ||
           comm.any(SCOTCH_dgraphPart(&handle, parts, &strategy, part.data()) != 0);
  if (failed) throw InputError("", 0, "PT-Scotch failed", "its own message stands above");
  return {part.begin(), part.end() - 1};
}

}  // namespace alphadot
