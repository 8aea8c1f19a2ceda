// Puts the cells of a mesh into the order of its pieces.
#pragma once

#include <vector>

#include "core/communicator.hpp"
#include "partition/mesh_part.hpp"
#include "partition/rank_mesh.hpp"

namespace alphadot {

/// A mesh whose cells lie piece by piece, so that any stretch of consecutive cells is compact: pieces follow
/// a space-filling curve, and so do the cells within each.
struct OrderedMesh {
  MeshPart part;                           ///< new ids, consecutive from rank to rank
  std::vector<GlobalIndex> triangle_cell;  ///< [part.triangles] id of the cell behind each; ascending
  std::vector<GlobalIndex> piece_begin;    ///< [pieces + 1] first cell of every piece; the same on every rank
};

/// `piece`, in [0, pieces): of every owned cell of `rank_mesh`. `points` is this rank's slab of the mesh's
/// points, whose ids stay. Collective.
OrderedMesh reorder(const RankMesh& rank_mesh, const std::vector<int>& piece, int pieces,
                    std::vector<Vec3> points, const Communicator& comm);

}  // namespace alphadot
