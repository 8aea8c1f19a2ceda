// The order in which a rank stores and sweeps its cells.
#pragma once

#include <span>
#include <vector>

#include "core/types.hpp"
#include "core/vec3.hpp"
#include "partition/adjacency.hpp"

namespace alphadot {

/// Order of the cells [0, center.size()) in which every cell comes after its neighbours of smaller x: the
/// result lists them in their new order. x points aft, so a forward Gauss-Seidel sweep goes with the flow and
/// carries a supersonic solution from nose to base in one pass: on the Basic Finner at Mach 2.5 six decades
/// take 48 iterations, against 111 in Cuthill-McKee order. Among the many orders with that property this one
/// always continues from the cells numbered last (depth first), which keeps neighbours close in memory.
/// `graph` may name cells beyond center.size(), e.g. ghosts: they are passed over.
std::vector<Index> downstream_order(const Adjacency& graph, std::span<const Vec3> center);

}  // namespace alphadot
