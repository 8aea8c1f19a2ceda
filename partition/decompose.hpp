// Cuts a mesh into parts of equal size and small surface.
#pragma once

#include <vector>

#include "core/communicator.hpp"
#include "partition/mesh.hpp"
#include "partition/rank_mesh.hpp"

namespace alphadot {

/// METIS works on the root, which holds the graph of the whole mesh (24 bytes a cell and METIS's own ten
/// times that); PT-Scotch works on all ranks together.
enum class Partitioner { metis, ptscotch };

/// The most cells that METIS's 32-bit indices can number together with their neighbours.
inline constexpr GlobalIndex most_cells_for_metis = GlobalIndex{1} << 28;

/// The part, in [0, parts), of every cell of `mesh`: METIS k-way partitioning of the dual graph, the same at
/// every call. Parts are in one piece when the mesh is. Not collective. Throws InputError when there are more
/// parts than cells, when a part would be empty, or above METIS's limit.
std::vector<int> decompose(const Mesh& mesh, int parts);

/// The part of every owned cell of `rank_mesh`, whose ids must be consecutive from rank to rank. Collective.
/// Throws InputError on all ranks as above; `file` is the mesh, for messages.
std::vector<int> decompose(const RankMesh& rank_mesh, int parts, Partitioner partitioner,
                           const std::string& file, const Communicator& comm);

}  // namespace alphadot
