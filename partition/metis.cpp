#include <metis.h>

#include <string>
#include <utility>

#include "core/error.hpp"
#include "partition/partitioners.hpp"

namespace alphadot {

namespace {

static_assert(sizeof(idx_t) == sizeof(Index), "METIS is built with another index width");

bool connected(const Adjacency& graph) {
  std::vector<char> seen(static_cast<std::size_t>(graph.rows()), 0);
  std::vector<Index> queue{0};
  seen[0] = 1;
  for (std::size_t next = 0; next < queue.size(); ++next)
    for (const Index neighbour : graph[queue[next]])
      if (!std::exchange(seen[neighbour], 1)) queue.push_back(neighbour);
  return queue.size() == seen.size();
}

}  // namespace

std::vector<int> metis_k_way(Adjacency& graph, int parts) {
  std::vector<idx_t> options(METIS_NOPTIONS);
  METIS_SetDefaultOptions(options.data());
  options[METIS_OPTION_NUMBERING] = 0;
  options[METIS_OPTION_SEED] = 1;
  options[METIS_OPTION_OBJTYPE] = METIS_OBJTYPE_CUT;
  options[METIS_OPTION_UFACTOR] = 10;                       // parts at most 1 % above the mean
  options[METIS_OPTION_CONTIG] = connected(graph) ? 1 : 0;  // METIS refuses it otherwise

  idx_t cells = graph.rows(), constraints = 1, count = parts, cut = 0;
  std::vector<idx_t> owner(static_cast<std::size_t>(cells));
  const int status =
      METIS_PartGraphKway(&cells, &constraints, graph.begin.data(), graph.items.data(), nullptr, nullptr,
                          nullptr, &count, nullptr, nullptr, options.data(), &cut, owner.data());
  if (status != METIS_OK) throw InputError("", 0, "METIS failed with status " + std::to_string(status));
  return owner;
}

}  // namespace alphadot
