#include "analysis/harmonic_derivatives.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "core/error.hpp"
#include "march/time_levels.hpp"

namespace alphadot {

namespace {

/// What the sine and cosine parts stand for; `rate_sign` is that of the variable against the angle's rate.
struct Meaning {
  std::optional<Variable> in_phase;
  Variable out_of_phase;
  Real rate_sign;
};

Meaning meaning_of(MotionKind motion) {
  switch (motion) {
    case MotionKind::plunge:
      return {Variable::alpha, Variable::alphadot, 1};
    case MotionKind::pitch:
      return {Variable::alpha, Variable::q_plus_alphadot, 1};
    case MotionKind::flap:
      return {std::nullopt, Variable::q, 1};
    case MotionKind::sway:
      return {Variable::beta, Variable::betadot, 1};
    case MotionKind::yaw:
      return {Variable::beta, Variable::r_minus_betadot, -1};
    case MotionKind::roll:
      return {std::nullopt, Variable::p, 1};
    default:
      throw InputError("", 0, "harmonic derivatives: the motion is not harmonic",
                       "use plunge, pitch, flap, sway, yaw or roll");
  }
}

/// The angle's own fit; refuses a history that is not the sine it is said to be.
HarmonicFit fit_angle(const ForceHistory& history, HarmonicBasis basis) {
  basis.phase = 0;
  basis.harmonics = 1;
  basis.drift = false;
  const HarmonicFit fit = fit_harmonics(basis, history.time, history.angle);
  const Real amplitude = std::hypot(fit.in_phase.value, fit.out_of_phase.value);
  // A prescribed motion is known to round-off; what a text file leaves of it is still far below this.
  constexpr Real tolerance = 1e-4;
  if (!(fit.rms <= tolerance * amplitude))
    throw InputError("", 0,
                     fmt::format("harmonic derivatives: the angle of the motion is not a sine of reduced "
                                 "frequency {:g} (misfit {:.2g} of its amplitude)",
                                 basis.reduced_frequency, fit.rms / amplitude),
                     "give the reduced frequency k = omega l / 2V of the run, l being its reference length");
  return fit;
}

/// What a first harmonic has of a kink, times its third. A load that goes as angle |angle| has five, one that
/// goes as rate |angle| five thirds; a kink elsewhere than at the mean may have more. A term of angle^3 has
/// three, one of rate angle^2 one.
constexpr Real of_kink = 6;
constexpr Real of_kink_in_rate = 2;
/// Of the largest amplitude part in a column, in all loads: terms of several kinds may cancel in a third
/// harmonic, not in the first. A pitch of 1 degree of a small cone had 3 % of CN's in Cm.
constexpr Real shared = 0.05;

}  // namespace

HarmonicDerivatives harmonic_derivatives(const ForceHistory& history, MotionKind motion,
                                         HarmonicBasis basis) {
  const Meaning meaning = meaning_of(motion);
  history.validate();
  const HarmonicFit angle = fit_angle(history, basis);
  basis.phase = std::atan2(angle.out_of_phase.value, angle.in_phase.value);

  HarmonicDerivatives result;
  result.mean_angle = angle.mean.value;
  result.amplitude = std::hypot(angle.in_phase.value, angle.out_of_phase.value);
  for (int c = 0; c < Coefficients::size(); ++c)
    result.fits[c] = fit_harmonics(basis, history.time, history.load(c), {}, history.bound(c));

  const Real k = basis.reduced_frequency, damping = damping_share(k * history.time_step);
  const Real per_angle = 1 / result.amplitude, per_rate = 1 / (k * result.amplitude);
  DerivativeSetOf<Real> fit, inner, time_step, amplitude;
  const auto add = [&](Variable variable, int c, const FittedAmplitude& part, Real scale, Real share,
                       Real third, Real damped) {
    result.estimated.derivatives[variable][c].value = scale * part.value;
    fit[variable][c] = std::abs(scale) * std::hypot(part.residual, part.half_cycles);
    inner[variable][c] = std::abs(scale) * part.samples;
    amplitude[variable][c] = share * std::abs(scale * third);
    time_step[variable][c] = damped;
  };
  for (int c = 0; c < Coefficients::size(); ++c) {
    const HarmonicFit& found = result.fits[c];
    const auto third = basis.harmonics >= 3 ? found.overtones[1] : std::array<Real, 2>{};
    const Real rate = per_rate * std::abs(found.out_of_phase.value);
    if (meaning.in_phase)
      add(*meaning.in_phase, c, found.in_phase, per_angle, of_kink, third[0], k * damping * rate);
    add(meaning.out_of_phase, c, found.out_of_phase, meaning.rate_sign * per_rate, of_kink_in_rate, third[1],
        damping * rate);
  }
  for (auto& [variable, column] : amplitude) {
    Real largest = 0;
    for (int c = 0; c < column.size(); ++c) largest = std::max(largest, column[c]);
    for (int c = 0; c < column.size(); ++c) column[c] = std::max(column[c], shared * largest);
  }
  result.estimated.add("fit", fit);
  result.estimated.add("inner", inner);
  result.estimated.add("time_step", time_step);
  result.estimated.add("amplitude", amplitude);
  return result;
}

}  // namespace alphadot
