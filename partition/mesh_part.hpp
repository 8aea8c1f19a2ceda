// A mesh spread over the ranks, before each knows its surroundings: no rank holds it whole.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "core/communicator.hpp"
#include "core/types.hpp"
#include "core/vec3.hpp"
#include "partition/mesh.hpp"

namespace alphadot {

/// A triangle of the boundary.
struct BoundaryTriangle {
  std::array<GlobalIndex, 3> points;
  GlobalIndex id;  ///< position among all triangles of the mesh
  GlobalIndex patch;
};

/// What one rank holds: cells with the triangles on them, and the points of its slab (see slabs.hpp), which
/// need not be those of its cells.
struct MeshPart {
  std::string file;  ///< where the mesh was read from, for messages
  GlobalIndex global_cells = 0, global_points = 0, global_triangles = 0;
  std::vector<std::string> patch_names;

  std::vector<GlobalIndex> cell_ids;              ///< [cells] ascending
  std::vector<std::array<GlobalIndex, 4>> cells;  ///< [cells] point ids, positive orientation
  std::vector<BoundaryTriangle> triangles;        ///< those on faces of the cells above, by id
  std::vector<Vec3> points;                       ///< [slab] mesh units
};

/// Spreads a mesh that the root holds (ignored elsewhere): `owner` is the rank of every cell. The root makes
/// and sends one part after the other. Collective.
MeshPart scatter(const Mesh& mesh, const std::vector<int>& owner, const Communicator& comm);

}  // namespace alphadot
