// One rank's share of the mesh with its metrics, neighbours and halo.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "core/communicator.hpp"
#include "core/types.hpp"
#include "core/vec3.hpp"
#include "partition/adjacency.hpp"
#include "partition/mesh.hpp"
#include "partition/mesh_part.hpp"

namespace alphadot {

/// The cells on either side of a face; the normal points from left to right.
struct FaceCells {
  Index left, right;
};

/// A face on the boundary of the domain.
struct BoundaryFace {
  Index cell;                   ///< owned cell
  Index patch;                  ///< index into Subdomain::patch_names
  std::array<Index, 3> points;  ///< local point ids, ordered so that the normal points outward
  GlobalIndex id;               ///< global id: position in the concatenated triangles of the mesh's patches
};

/// What this rank exchanges with one other rank. Ghosts of one owner are contiguous, those that share a face
/// with an owned cell first, so that both kinds of exchange receive in place.
struct HaloNeighbour {
  int rank;
  std::vector<Index> send;  ///< owned cells that are ghosts over there, in the order of the ghosts over there
  Index send_face_count;    ///< the first this many of `send` share a face with a cell over there
  Index ghost_begin;        ///< local id of the first ghost owned by `rank`
  Index ghost_count;
  Index ghost_face_count;  ///< the first this many ghosts share a face with an owned cell
};

/// The share of one rank. Cell ids: [0, interior_cells) touch no ghost, [interior_cells, owned_cells) share a
/// point with a ghost, [owned_cells, total_cells) are ghosts: every cell of another rank that shares a point
/// with an owned cell. Metrics are in mesh units times the scale given to `distribute`.
struct Subdomain {
  Index interior_cells = 0, owned_cells = 0, total_cells = 0;
  GlobalIndex global_cells = 0;  ///< over all ranks
  GlobalIndex global_points = 0;

  std::vector<Vec3> points;            ///< points of all local cells
  std::vector<GlobalIndex> point_ids;  ///< [points] global ids
  Index interior_points =
      0;                   ///< the first this many points belong to interior cells: no ghost is around them
  Index owned_points = 0;  ///< the first this many points belong to owned cells
  std::vector<std::array<Index, 4>> cell_points;  ///< [total_cells] local point ids, positive orientation
  std::vector<GlobalIndex> cell_ids;              ///< [total_cells] global ids (position in the mesh file)
  std::vector<Real> volume;                       ///< [total_cells] > 0
  std::vector<Vec3> center;                       ///< [total_cells] centroids

  /// Faces between two cells: first those between owned cells (left < right, sorted by left then right), then
  /// from `cut_face_begin` on those between an owned cell (left) and a ghost (right).
  std::vector<FaceCells> faces;
  Index cut_face_begin = 0;
  std::vector<Vec3> face_normal;                  ///< [faces] area vector from left to right
  std::vector<Vec3> face_center;                  ///< [faces] centroid
  std::vector<std::array<Index, 3>> face_points;  ///< [faces] local point ids, right-handed about the normal

  std::vector<std::string> patch_names;      ///< same on every rank
  std::vector<BoundaryFace> boundary_faces;  ///< sorted by patch, then by cell
  std::vector<Vec3> boundary_normal;         ///< [boundary_faces] outward area vector
  std::vector<Vec3> boundary_center;         ///< [boundary_faces] centroid

  Adjacency cell_faces;   ///< [owned_cells] -> ids into `faces`, ascending neighbour order
  Adjacency point_cells;  ///< [owned_points] -> every local cell (ghosts included) around the point: complete

  std::vector<HaloNeighbour> neighbours;  ///< ascending rank

  /// Recomputes volume, center, face_* and boundary_* metrics from `points` (after the points have moved).
  void update_metrics();

  /// Checks every invariant above (closed cells: outward area vectors sum to zero within round-off of their
  /// magnitude; positive volumes; symmetric neighbours; outward normals; every owned cell has four faces,
  /// boundary ones included). Throws std::logic_error naming the first breach.
  void validate() const;

  /// Bytes held by the arrays above.
  std::size_t bytes() const;
};

/// Cuts `mesh` (filled on the root; ignored elsewhere) into one part a rank with METIS on the dual graph,
/// renumbers the cells of each part for locality and sweeps (see ordering.hpp) and builds the halo. Points
/// are multiplied by `scale`. Collective. Throws InputError on all ranks when there are more ranks than
/// cells, when a rank would be empty, or above METIS's 32-bit limit. `mesh` must have passed
/// Mesh::validate().
Subdomain distribute(const Mesh& mesh, const Communicator& comm, Real scale = 1.0);

/// The same from a given owner of every cell (root only): for tests and for prepared partitions.
Subdomain distribute(const Mesh& mesh, const std::vector<int>& owner, const Communicator& comm,
                     Real scale = 1.0);

/// The same from a mesh whose cells have reached their owners.
Subdomain distribute(MeshPart part, const Communicator& comm, Real scale = 1.0);

}  // namespace alphadot
