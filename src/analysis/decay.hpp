// What the free oscillation of a body tells: frequency, damping, and derivatives.
#pragma once

#include <span>
#include <vector>

#include "analysis/derivatives.hpp"
#include "analysis/force_history.hpp"

namespace alphadot {

/// y = mean + exp(-damping t*) (a cos k t* + b sin k t*). Half widths hold the fit's random part, correlated
/// in time, what the fit to the later two thirds of the window says otherwise, what the second and third
/// harmonics tell of terms that are not linear in the angle, and all that was taken off for the time step.
struct Decay {
  Estimate frequency;  ///< k = omega l / (2V)
  Estimate damping;    ///< per unit of t*; negative where the motion grows
  Estimate mean;
  Real rms = 0;     ///< of the residual
  Real start = 0;   ///< t* of the window, behind the first quarter of a cycle, which is left out
  Real cycles = 0;  ///< of the window
};

/// Cycles at the start that no fit of a free motion uses, while the flow takes it up, and the shortest window
/// behind them.
inline constexpr Real free_discarded_cycles = 0.25, least_free_cycles = 1;

/// Fits an angle that swings freely. `time`: t* at even steps. Least squares (Gauss and Newton's iteration)
/// from a linear prediction (de Prony). A motion by the trapezoidal rule in steps of `time_step` (t*; 0:
/// exact in time) swings as exp(s' t*) with 2 tanh(s' time_step / 2) = s time_step: what is given is s.
/// Throws InputError for a record that does not swing or is too short.
Decay fit_decay(std::span<const Real> time, std::span<const Real> angle, Real time_step);

/// Derivatives by alpha and q + alphadot of a motion in pitch alone: least squares on X = X_0 + X_alpha alpha
/// + X_q_plus_alphadot q* in the window of its decay; `rate` is q*. Half widths: the fit's as in Decay, the
/// bounds' worst case, what BDF2 with the history's time step at most adds to the part of a rate, and what
/// terms up to the third order in the angle change. Throws InputError.
EstimatedDerivatives free_pitch_derivatives(const ForceHistory& history, std::span<const Real> rate,
                                            const Decay& decay);

}  // namespace alphadot
