// Places in space in an order in which neighbours are near each other.
#pragma once

#include <cstdint>

#include "core/vec3.hpp"
#include "partition/box.hpp"

namespace alphadot {

/// Position of the point `at` along a Hilbert curve through the box, of 2^63 steps (Skilling 2004). Points
/// near each other along the curve are near each other in space, so that a stretch of it is a compact part.
std::uint64_t hilbert_position(const Vec3& at, const Box& box);

}  // namespace alphadot
