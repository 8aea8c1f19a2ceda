// Scalar and index types used by every floor.
#pragma once

#include <cstdint>

namespace alphadot {

using Real = double;
using Index = std::int32_t;        ///< local (per rank) ids of cells, faces, points
using GlobalIndex = std::int64_t;  ///< ids that are unique over all ranks

inline constexpr Real pi = 3.14159265358979323846;
inline constexpr Real radians_per_degree = pi / 180;

}  // namespace alphadot
