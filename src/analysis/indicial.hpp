// Derivatives from the response to a step in alpha or in pitch rate.
#pragma once

#include <span>

#include "analysis/derivatives.hpp"
#include "analysis/force_history.hpp"
#include "motion/settings.hpp"

namespace alphadot {

/// What a step response X(t*) tells.
struct StepFit {
  Estimate final;    ///< value that the response tends to
  Estimate deficit;  ///< integral of X_final - X over t* from 0 to infinity
  Real tail = 0;     ///< share of `deficit` that lies beyond the record
  /// Parts of the uncertainties: what halving the number of samples changes in the deficit, and the bounds.
  Real sampling = 0, inner_of_final = 0, inner_of_deficit = 0;
};

/// Integrates the response `y` at `time` (t* >= 0, increasing, at least least_step_samples); the step is at
/// t* = 0 and a sample there holds the value just after it. Before the first sample the response is taken as
/// constant.
///
/// X_final and the tail: the means m1, m2, m3 of the last three tenths of the record. A tail is over, and
/// nothing is extrapolated, when the means of the six halves of these tenths do not all go one way, or m3
/// differs from m2 by no more than the bounds there. When the means approach a limit geometrically otherwise,
/// rho = (m3 - m2) / (m2 - m1) in (0, 0.8), the response ends as an exponential, for which X_final = m3 + (m3
/// - m2) rho / (1 - rho) and tail = (X_final - m3) h rho / (1 - rho) hold exactly, h being a tenth of the
/// record. Otherwise X_final = m3 and there is no tail. Uncertainty of X_final: half again the range of the
/// three means and X_final; when rho >= 0.8, nine times the last change at least, for the response may still
/// be on its way. Of the deficit: that times the length of the record, the whole tail, and what halving the
/// number of samples changes. Both: the worst case of `bounds` (largest error of each sample; may be empty).
/// Throws InputError for too few, unordered or not finite samples.
StepFit fit_step(std::span<const Real> time, std::span<const Real> y, std::span<const Real> bounds = {});

/// Derivatives from a step of size `step`: rad for step_alpha, reduced rate q* = q l/2V for step_q; `initial`
/// are the loads before it. With X_alphadot = -(2V/l) times the integral of (X_final - X) dt per unit step
/// (linear superposition of steps, to first order in frequency):
///   step_alpha: alpha and alphadot;  step_q: q (rotation with alpha held).
/// Parts of the uncertainty: "fit", "inner" (the bounds) and "time_step" (the number of samples; the sum of
/// the responses over the steps is itself right to second order in the step, however long that is beside the
/// response, for backward differences telescope). A finite step's non-linearity is in none of them.
/// Throws InputError as fit_step does, for another motion and for a step of zero.
EstimatedDerivatives step_derivatives(const ForceHistory& history, MotionKind motion,
                                      const Coefficients& initial, Real step);

}  // namespace alphadot
