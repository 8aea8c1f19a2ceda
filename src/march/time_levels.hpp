// Backward differences in time.
#pragma once

#include "core/types.hpp"

namespace alphadot {

/// dU/dt = now U^n+1 + old U^n + older U^n-1.
struct TimeWeights {
  Real now, old, older;
};

/// BDF2, but backward Euler in the first step: what sets in at t = 0 with a jump would otherwise lag by half
/// a step ever after. One step of first order leaves the whole second order.
inline TimeWeights time_weights(int step, Real time_step) {
  if (step <= 1) return {1 / time_step, -1 / time_step, 0};
  return {1.5 / time_step, -2 / time_step, 0.5 / time_step};
}

}  // namespace alphadot
