// What a rank needs of the mesh: its cells, the cells around them, their points and boundary triangles.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "core/communicator.hpp"
#include "core/types.hpp"
#include "core/vec3.hpp"
#include "partition/mesh_part.hpp"

namespace alphadot {

/// Raw material of a Subdomain: local point ids, nothing ordered for speed yet.
struct RankMesh {
  GlobalIndex global_cells = 0, global_points = 0;
  std::vector<std::string> patch_names;

  std::vector<GlobalIndex> cell_ids;              ///< [cells] owned ones, then ghosts; both ascending
  std::vector<std::array<Index, 4>> cell_points;  ///< [cells] local point ids
  std::vector<int> ghost_owner;                   ///< [ghosts] rank
  Index owned_cells() const { return static_cast<Index>(cell_ids.size() - ghost_owner.size()); }

  std::vector<GlobalIndex> point_ids;  ///< [points] global ids, in order of first use by cell_points
  std::vector<Vec3> points;            ///< [points] mesh units

  std::vector<std::array<Index, 3>> triangles;  ///< [triangles] local point ids; on faces of owned cells
  std::vector<GlobalIndex> triangle_ids;        ///< [triangles] position among all triangles of the mesh
  std::vector<Index> triangle_patch;            ///< [triangles] index into patch_names
};

/// Finds the surroundings of every rank's part: ranks that use the same points send each other the cells
/// around them. No rank holds more than its part and its surroundings; about 70 bytes a cell beside the part.
/// Collective. Throws InputError on all ranks when a point id is out of range.
RankMesh gather_rank_mesh(MeshPart part, const Communicator& comm);

}  // namespace alphadot
