#include "partition/decompose.hpp"

#include <algorithm>
#include <string>
#include <utility>

#include "core/error.hpp"
#include "partition/delivery.hpp"
#include "partition/dual_graph.hpp"
#include "partition/partitioners.hpp"

namespace alphadot {

namespace {

void check_request(GlobalIndex cells, int parts, Partitioner partitioner, const std::string& file) {
  if (parts > cells)
    throw InputError(file, 0, std::to_string(parts) + " ranks for " + std::to_string(cells) + " cells",
                     "use at most one rank a cell");
  if (partitioner == Partitioner::metis && cells > most_cells_for_metis)
    throw InputError(file, 0, std::to_string(cells) + " cells are too many for the 32-bit indices of METIS",
                     "use PT-Scotch: alphadot partition --method ptscotch");
}

/// `size`: cells of every part.
void check_parts(const std::vector<GlobalIndex>& size, GlobalIndex cells, const std::string& file) {
  const auto empty = std::count(size.begin(), size.end(), 0);
  if (empty > 0)
    throw InputError(file, 0,
                     std::to_string(size.size()) + " ranks for " + std::to_string(cells) +
                         " cells: " + std::to_string(empty) + " of them would be without a cell",
                     "use fewer ranks");
}

std::vector<GlobalIndex> sizes(const std::vector<int>& part_of, int parts) {
  std::vector<GlobalIndex> size(static_cast<std::size_t>(parts), 0);
  for (const int part : part_of) ++size[static_cast<std::size_t>(part)];
  return size;
}

/// The dual graph's rows of the owned cells, with global ids.
DistributedGraph graph_of(const RankMesh& rank_mesh) {
  const Adjacency local = dual_graph(rank_mesh.cell_points, rank_mesh.points.size());
  DistributedGraph out;
  for (Index cell = 0; cell < rank_mesh.owned_cells(); ++cell) {
    for (const Index neighbour : local[cell]) out.items.push_back(rank_mesh.cell_ids[neighbour]);
    out.begin.push_back(static_cast<GlobalIndex>(out.items.size()));
  }
  return out;
}

/// Of items that go to the root only.
std::vector<int> all_to_root(std::size_t items, const Communicator& comm) {
  std::vector<int> counts(static_cast<std::size_t>(comm.size()), 0);
  counts[0] = item_count(items);
  return counts;
}

/// METIS on the root, for a graph that all ranks hold in turn.
std::vector<int> metis_on_root(const DistributedGraph& graph, int parts, const Communicator& comm) {
  std::vector<Index> items(graph.items.begin(), graph.items.end()), degrees;
  for (std::size_t i = 0; i + 1 < graph.begin.size(); ++i)
    degrees.push_back(static_cast<Index>(graph.begin[i + 1] - graph.begin[i]));
  Adjacency whole;
  whole.items = deliver<Index>(items, all_to_root(items.size(), comm), comm).items;
  const auto all_degrees = deliver<Index>(degrees, all_to_root(degrees.size(), comm), comm);
  for (const Index degree : all_degrees.items) whole.begin.push_back(whole.begin.back() + degree);
  std::vector<int> part_of;
  comm.on_root([&] { part_of = metis_k_way(whole, parts); });
  return deliver<int>(part_of, all_degrees.counts, comm).items;
}

}  // namespace

std::vector<int> decompose(const Mesh& mesh, int parts) {
  const auto cells = static_cast<GlobalIndex>(mesh.cells.size());
  check_request(cells, parts, Partitioner::metis, mesh.file);
  if (parts == 1) return std::vector<int>(mesh.cells.size(), 0);
  Adjacency graph = dual_graph(mesh.cells, mesh.points.size());
  std::vector<int> part_of = metis_k_way(graph, parts);
  check_parts(sizes(part_of, parts), cells, mesh.file);
  return part_of;
}

std::vector<int> decompose(const RankMesh& rank_mesh, int parts, Partitioner partitioner,
                           const std::string& file, const Communicator& comm) {
  comm.on_all([&] { check_request(rank_mesh.global_cells, parts, partitioner, file); });
  if (parts == 1) return std::vector<int>(static_cast<std::size_t>(rank_mesh.owned_cells()), 0);
  DistributedGraph graph = graph_of(rank_mesh);
  auto part_of = partitioner == Partitioner::metis ? metis_on_root(graph, parts, comm)
                                                   : ptscotch_k_way(graph, parts, comm);
  auto size = sizes(part_of, parts);
  comm.sum(std::span<GlobalIndex>(size));
  comm.on_all([&] { check_parts(size, rank_mesh.global_cells, file); });
  return part_of;
}

}  // namespace alphadot
