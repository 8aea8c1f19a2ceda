// What a rank needs of the mesh: its cells, the cells around them, their points and boundary triangles.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "core/communicator.hpp"
#include "core/types.hpp"
#include "core/vec3.hpp"
#include "partition/mesh.hpp"

namespace alphadot {

/// Raw material of a Subdomain, as cut from the mesh: local point ids, nothing ordered for speed yet.
struct Share {
  GlobalIndex global_cells = 0, global_points = 0;
  std::vector<std::string> patch_names;

  std::vector<GlobalIndex> cell_ids;              ///< [cells] owned ones, then ghosts; both ascending
  std::vector<std::array<Index, 4>> cell_points;  ///< [cells] local point ids
  std::vector<int> ghost_owner;                   ///< [ghosts] rank
  Index owned_cells() const { return static_cast<Index>(cell_ids.size() - ghost_owner.size()); }

  std::vector<GlobalIndex> point_ids;  ///< [points] global ids, in order of first use by cell_points
  std::vector<Vec3> points;            ///< [points] mesh units

  std::vector<std::array<Index, 3>> triangles;  ///< [triangles] local point ids; on faces of owned cells
  std::vector<GlobalIndex> triangle_ids;        ///< [triangles] position in the concatenated patches
  std::vector<Index> triangle_patch;            ///< [triangles] index into patch_names
};

/// Gives every rank its share. `mesh` and `owner` (the rank of every cell) are read on the root only, which
/// sends one share after the other and holds no more than one at a time. Collective.
Share scatter_shares(const Mesh& mesh, const std::vector<int>& owner, const Communicator& comm);

}  // namespace alphadot
