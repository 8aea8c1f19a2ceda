// The order in which a rank stores and sweeps its cells.
#pragma once

#include <span>
#include <vector>

#include "core/types.hpp"
#include "core/vec3.hpp"
#include "partition/adjacency.hpp"

namespace alphadot {

/// Cuthill-McKee order of the cells [0, center.size()): the result lists them in their new order. Levels grow
/// from the cell of smallest x, the most upstream one in body axes, so that a forward LU-SGS sweep goes with
/// the flow and neighbours stay close in memory. (Cuthill and McKee, 1969; not reversed, since reversal helps
/// the fill of a factorisation, which LU-SGS has none of, and would sweep upstream first.)
/// `graph` may name cells beyond center.size(), e.g. ghosts: they are passed over.
std::vector<Index> upstream_cuthill_mckee(const Adjacency& graph, std::span<const Vec3> center);

}  // namespace alphadot
