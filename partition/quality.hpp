// How good the cells of a mesh are, and where the worst ones lie.
#pragma once

#include "core/communicator.hpp"
#include "core/types.hpp"
#include "core/vec3.hpp"
#include "partition/subdomain.hpp"

namespace alphadot {

/// The cell with the most extreme value of some measure.
struct WorstCell {
  Real value = 0;
  GlobalIndex id = 0;
  Vec3 at;  ///< its centroid
};

struct MeshQuality {
  WorstCell smallest_angle;  ///< between two faces of a cell, degrees; 70.5 in a regular one
  WorstCell aspect_ratio;    ///< longest edge over smallest height; 1 for a regular cell
  WorstCell volume_ratio;    ///< of two cells that share a face, larger over smaller; names the smaller
};

/// The same to the last bit at any number of ranks; of equally bad cells the one with the smallest id.
/// Collective; 0.2 us a cell.
MeshQuality mesh_quality(const Subdomain& domain, const Communicator& comm);

}  // namespace alphadot
