// Uniform refinement of a mesh that is spread over the ranks.
#pragma once

#include "core/communicator.hpp"
#include "partition/mesh_part.hpp"

namespace alphadot {

/// Every tetrahedron into eight: four at its corners, and the octahedron between them into four about its
/// shortest diagonal (Bey 1995). Every boundary triangle into four. New points are the middles of edges, so
/// curved walls stay the facets that they were. Children of cell i have the ids 8 i to 8 i + 7. Collective;
/// about 150 bytes a cell before refinement, beside both parts.
MeshPart refine(MeshPart part, const Communicator& comm);

}  // namespace alphadot
