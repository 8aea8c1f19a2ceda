// From a rank's raw mesh to its ordered Subdomain.
#pragma once

#include "core/types.hpp"
#include "partition/rank_mesh.hpp"
#include "partition/subdomain.hpp"

namespace alphadot {

/// Orders cells and points, finds faces and neighbours and computes metrics of points times `scale`. Needs no
/// messages: the ghosts alone tell which owned cells others need, and in which order. Throws std::logic_error
/// when an owned cell has a face without neighbour or boundary triangle (Mesh::validate() excludes it).
Subdomain build_subdomain(RankMesh rank_mesh, Real scale);

}  // namespace alphadot
