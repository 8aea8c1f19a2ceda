// Derivatives from the response to a ramp: alpha growing at a constant rate.
#pragma once

#include "analysis/derivatives.hpp"
#include "analysis/force_history.hpp"

namespace alphadot {

/// alpha and alphadot derivatives from a plunging ramp. Once the start has passed over the body,
///   X = X0 + X_alpha (alpha - alpha0) + X_alphadot alphadot*,
/// so that the slope against alpha is X_alpha and the intercept X_alphadot times the constant rate. `initial`
/// and `initial_angle` (rad) belong to the steady state before; samples from t* = `transient` on are used: a
/// start passes a body of length L in about 2 L / l * M / (M - 1). Uncertainty: 95 % of the fit, in
/// quadrature with what the difference of the two halves of the window tells of a start not yet over, or of a
/// term that goes as the square of the angle, the part "fit"; plus the worst case of the history's bounds,
/// the part "inner". Backward differences of second order are exact along a ramp. Throws InputError when
/// fewer than least_ramp_samples remain or the rate is not constant (to 1e-6 of the rise) on them.
EstimatedDerivatives ramp_derivatives(const ForceHistory& history, const Coefficients& initial,
                                      Real initial_angle, Real transient);

}  // namespace alphadot
