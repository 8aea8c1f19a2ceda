// Cuts a mesh into parts of equal size and small surface.
#pragma once

#include <vector>

#include "partition/mesh.hpp"

namespace alphadot {

/// The part, in [0, parts), of every cell of `mesh`: METIS k-way partitioning of the dual graph, the same at
/// every call. Parts are in one piece when the mesh is. Not collective. Throws InputError when there are more
/// parts than cells, when a part would be empty, or above METIS's 32-bit limit.
std::vector<int> decompose(const Mesh& mesh, int parts);

}  // namespace alphadot
