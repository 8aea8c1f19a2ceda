#include "partition/decompose.hpp"

#include <metis.h>

#include <algorithm>
#include <string>
#include <utility>

#include "core/error.hpp"
#include "partition/dual_graph.hpp"
#include "partition/face_matching.hpp"

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

std::vector<idx_t> k_way(Adjacency& graph, int parts) {
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

}  // namespace

std::vector<int> decompose(const Mesh& mesh, int parts) {
  const GlobalIndex cells = static_cast<GlobalIndex>(mesh.cells.size());
  if (parts > cells)
    throw InputError(mesh.file, 0, std::to_string(parts) + " ranks for " + std::to_string(cells) + " cells",
                     "use at most one rank a cell");
  if (cells > max_cells_for_faces)  // 4 neighbours each: half of what METIS's 32-bit indices can count
    throw InputError(mesh.file, 0,
                     std::to_string(cells) + " cells are too many for the 32-bit indices of METIS",
                     "use at most " + std::to_string(max_cells_for_faces) + " cells");
  if (parts == 1) return std::vector<int>(mesh.cells.size(), 0);

  Adjacency graph = dual_graph(mesh.cells, mesh.points.size());
  std::vector<int> owner = k_way(graph, parts);

  std::vector<GlobalIndex> size(static_cast<std::size_t>(parts), 0);
  for (const int part : owner) ++size[part];
  const auto empty = std::count(size.begin(), size.end(), 0);
  if (empty > 0)
    throw InputError(mesh.file, 0,
                     std::to_string(parts) + " ranks for " + std::to_string(cells) + " cells: METIS left " +
                         std::to_string(empty) + " of them without a cell",
                     "use fewer ranks");
  return owner;
}

}  // namespace alphadot
