// Backward differences in time.
#pragma once

#include <cmath>

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

/// The time step that the weights are to be given for steps of `time_step` along a motion of angular
/// frequency `omega`. BDF2 makes of exp(i omega t), with theta = omega dt,
///   (3 - 4 exp(-i theta) + exp(-2 i theta)) / (2 dt) = ((1 - cos theta)^2 + i sin theta (2 - cos theta)) /
///   dt:
/// a derivative that is too large by theta^2 / 3, and with it everything that is in phase with a rate. With
/// this step it is i omega and a lag of third order (Gautschi, Numer. Math. 3, 1961, 381: backward
/// differences that are exact for a sine). omega = 0: the step itself.
inline Real fitted_step(Real time_step, Real omega) {
  const Real theta = omega * time_step;
  return theta == 0 ? time_step : std::sin(theta) * (2 - std::cos(theta)) / omega;
}

/// What is left: BDF2 with the fitted step makes i omega (1 - i share) of the derivative.
inline Real damping_share(Real theta) {
  if (theta == 0) return 0;
  return std::pow(1 - std::cos(theta), 2) / (std::sin(theta) * (2 - std::cos(theta)));
}

}  // namespace alphadot
