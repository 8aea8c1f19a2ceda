// Adding an implicit update to the flow without leaving physical states.
#pragma once

#include <algorithm>
#include <cmath>

#include "euler/state.hpp"

namespace alphadot {

/// No cell's density or pressure changes by more than this share of itself in one update.
inline constexpr Real update_cap = 0.3;

/// Share (0, 1] of `update` that keeps within the cap.
inline Real capped_share(const Primitive<Real>& w, const Primitive<Real>& update) {
  const Real density = std::abs(update[0]) / w[0], pressure = std::abs(update[4]) / w[4];
  return std::min(Real{1}, update_cap / std::max({density, pressure, Real{1e-300}}));
}

}  // namespace alphadot
