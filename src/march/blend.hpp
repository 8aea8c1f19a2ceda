// How far meshes follow what moves in them.
#pragma once

#include <algorithm>

#include "core/types.hpp"

namespace alphadot {

/// 1 up to 0, 0 from 1 on, two continuous derivatives between.
inline Real blend(Real way) {
  const Real s = std::clamp(way, Real{0}, Real{1});
  return 1 - s * s * s * (10 - s * (15 - 6 * s));
}

}  // namespace alphadot
