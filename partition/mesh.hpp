// The whole mesh as read from a file, before it is cut into ranks.
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "core/types.hpp"
#include "core/vec3.hpp"

namespace alphadot {

/// A named part of the boundary: the triangles of one physical group or marker.
struct Patch {
  std::string name;
  std::vector<std::array<GlobalIndex, 3>> triangles;  ///< point ids; any orientation
};

/// A named part of the volume: the cells from `first_cell` up to that of the next one.
struct NamedVolume {
  std::string name;
  GlobalIndex first_cell;
};

/// An unstructured tetrahedral mesh. Points in mesh units; cells are tetrahedra with positive volume:
/// (p1-p0) x (p2-p0) . (p3-p0) > 0.
struct Mesh {
  std::string file;                               ///< where it was read from, for messages
  std::vector<Vec3> points;                       ///< [points]
  std::vector<std::array<GlobalIndex, 4>> cells;  ///< [cells] point ids
  std::vector<Patch> patches;
  /// By first cell, if the file tells; one name may come several times.
  std::vector<NamedVolume> volumes = {};

  /// The name of the volume that a cell belongs to; empty when the file tells none.
  std::string_view volume_of(GlobalIndex cell) const;
  /// The triangles of all patches one after the other.
  std::vector<std::array<GlobalIndex, 3>> boundary_triangles() const;

  /// Checks every invariant: finite points, point ids in range and distinct within a cell, positive volumes,
  /// no face shared by more than two cells, every face with one cell is covered by exactly one boundary
  /// triangle, every boundary triangle is a face of exactly one cell, at least one cell.
  /// Throws InputError naming the file, the first bad cell or triangle (its id and coordinates), the number
  /// of such defects, the reason and a remedy.
  void validate() const;

  /// Order-dependent 64-bit hash of points, cells and patches, as 16 hexadecimal digits: the mesh's identity
  /// in checkpoints and provenance.
  std::string hash() const;
};

}  // namespace alphadot
