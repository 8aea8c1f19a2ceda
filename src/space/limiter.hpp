// Slope limiters: by how much a gradient is reduced so that reconstruction makes no new extrema.
#pragma once

#include <cmath>

#include "core/dual.hpp"
#include "core/four.hpp"
#include "space/settings.hpp"

namespace alphadot {

/// Venkatakrishnan 1995, equation (18): smooth in `delta` (the reconstructed change) against `bound` (the
/// change to the extremum of the neighbourhood on the same side); changes much below the root of `epsilon2`
/// pass. Both signs of delta and bound alike.
template <class T, class E>
T venkatakrishnan(const T& delta, const T& bound, const E& epsilon2) {
  const T top = bound * bound + epsilon2 + 2.0 * delta * bound;
  return top / (top + delta * (2.0 * delta - bound));
}

/// Barth & Jespersen 1989: the largest factor up to one that stays within the extremum.
template <class T>
T barth_jespersen(const T& delta, const T& bound) {
  return value_of(delta) == 0 || bound / delta >= T(1) ? T(1) : T(bound / delta);
}
inline FourReals barth_jespersen(const FourReals& delta, const FourReals& bound) {
  return delta == 0 ? four(1) : minimum(bound / delta, four(1));
}

/// MLP looks at each corner and its own extrema; the others at the face opposite, a third of the offset
/// beyond the centroid, and the extrema of all corners.
constexpr bool is_at_corners(LimiterKind limiter) {
  return limiter == LimiterKind::mlp_u2;
}
constexpr Real to_face = 1.0 / 3;
/// Where a limiter looks from the centroid, in vectors from a corner to it.
constexpr Real reach(LimiterKind limiter) {
  return is_at_corners(limiter) ? -1.0 : to_face;
}

/// Share of a limited gradient that leaves every face of the cell half of the cell's density and pressure
/// (the scaling of Zhang & Shu 2010). `lowest`: the smallest ratio of a face's value to the cell's. Without
/// it a cell in a strong expansion can lose energy through one face for ever while others fall back, and runs
/// into vacuum.
inline Real positive_share(Real lowest) {
  constexpr Real kept = 0.5;
  return lowest >= kept ? 1 : (1 - kept) / (1 - lowest);
}

}  // namespace alphadot
