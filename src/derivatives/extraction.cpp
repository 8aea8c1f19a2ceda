#include "derivatives/extraction.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "analysis/harmonic_derivatives.hpp"
#include "analysis/indicial.hpp"
#include "analysis/ramp.hpp"
#include "core/error.hpp"
#include "core/fit_needs.hpp"
#include "derivatives/remaining_error.hpp"
#include "motion/motion.hpp"

namespace alphadot {

namespace {

/// Column that the motion's angle is recorded in.
std::string angle_column(MotionKind kind) {
  switch (kind) {
    case MotionKind::sway:
    case MotionKind::yaw:
      return "beta";
    case MotionKind::flap:
      return "theta";
    case MotionKind::roll:
      return "phi";
    default:
      return "alpha";
  }
}

/// The history from one row on.
ForceHistory force_history(const History& history, std::size_t first) {
  ForceHistory out;
  const auto from = [&](const std::string& column) {
    const auto& values = history.column(column);
    return std::vector<Real>(values.begin() + static_cast<std::ptrdiff_t>(std::min(first, values.size())),
                             values.end());
  };
  out.time = from("t_star");
  if (out.time.size() > 1) out.time_step = out.time.back() - out.time[out.time.size() - 2];
  out.angle = from(angle_column(history.info.motion.kind));
  out.loads.resize(out.time.size());
  out.bounds.resize(out.time.size());
  for (int i = 0; i < Coefficients::size(); ++i) {
    const auto name = std::string(coefficient_names[static_cast<std::size_t>(i)]);
    const auto values = from("total/" + name), bounds = from("error/" + name);
    for (std::size_t step = 0; step < values.size(); ++step) {
      out.loads[step][i] = values[step];
      out.bounds[step][i] = std::abs(bounds[step]);
    }
  }
  return out;
}

/// Loads of the first row, those before the motion.
Coefficients initial_loads(const History& history) {
  Coefficients out;
  for (int i = 0; i < Coefficients::size(); ++i)
    out[i] = history.column("total/" + std::string(coefficient_names[static_cast<std::size_t>(i)])).front();
  return out;
}

/// Of the flow before a motion, rad.
Real incidence_before(const History& history) {
  return std::hypot(history.column("alpha").front(), history.column("beta").front());
}

Real largest_of(const CoefficientsOf<Estimate>& column) {
  Real largest = 0;
  for (int i = 0; i < column.size(); ++i) largest = std::max(largest, std::abs(column[i].value));
  return largest;
}

/// Motions that are too small for terms of higher order still meet the bends of a discrete flow. Over a ramp
/// of `duration`, in t*, those by the angle count by the rate too.
void add_bends(EstimatedDerivatives& estimated, Real duration = 0) {
  DerivativeSetOf<Real> out;
  for (const auto& [variable, column] : estimated.derivatives) {
    Real largest = largest_of(column);
    if (variable == Variable::alphadot && duration > 0)
      largest += duration * largest_of(estimated.at(Variable::alpha));
    for (int i = 0; i < column.size(); ++i) out[variable][i] = bends * largest;
  }
  estimated.add("bends", std::move(out));
}

/// What a finite angle does to derivatives from a single step or ramp, which cannot tell it from the rest: a
/// bound by experience, in the largest load of a column. A load that is odd in the angle, as x + c x^3, has
/// the slope c (3 x a + a^2) off between x and x + a, x being the `incidence` of the flow before; 15 a (x +
/// a) holds it. CA is even, and 2 a is added. Steps of up to 5 degrees of a wedge at Mach 2 and of a
/// cone at Mach 1.58 and 2.5 reach three quarters of this without incidence, the cone's half of it at 4 and 8
/// degrees.
void add_amplitude(EstimatedDerivatives& estimated, Real angle, Real incidence) {
  constexpr Real of_odd = 15, of_even = 2;
  const Real a = std::abs(angle), share = of_odd * a * (incidence + a);
  DerivativeSetOf<Real> out;
  for (const auto& [variable, column] : estimated.derivatives) {
    const Real largest = largest_of(column);
    for (int i = 0; i < column.size(); ++i) out[variable][i] = share * largest;
    out[variable].CA += of_even * a * largest;
  }
  estimated.add("amplitude", std::move(out));
}

/// The incidence, or that to which a camber that gives the loads before a step or ramp of alpha amounts.
Real incidence_of_loads(const Coefficients& before, const EstimatedDerivatives& estimated) {
  const Real slope = std::abs(estimated.at(Variable::alpha).CN.value);
  return slope > 0 ? std::abs(before.CN) / slope : 0;
}

/// A body that moves across the axis of a stream with incidence changes its speed too.
std::string at_incidence(const History& history) {
  constexpr Real none = 1e-9;
  return incidence_before(history) > none ? ", at constant axial velocity" : "";
}

/// Cycles at the start of a motion that no fit uses.
constexpr Real least_discarded = 0.1;

Extraction harmonic_extraction(const History& history, const HarmonicBasis& basis) {
  const auto& motion = history.info.motion;
  const bool is_carried = motion.kind == MotionKind::plunge || motion.kind == MotionKind::sway;
  auto estimated = harmonic_derivatives(force_history(history, 0), motion.kind, basis).estimated;
  add_bends(estimated);
  return {std::move(estimated),
          fmt::format("harmonic fit, {}, k = {}{}", word_of(motion.kind), motion.reduced_frequency,
                      is_carried ? at_incidence(history) : "")};
}

}  // namespace

Extraction extract_derivatives(const History& history) {
  const auto& motion = history.info.motion;
  switch (motion.kind) {
    case MotionKind::none:
    case MotionKind::table:
    case MotionKind::free:
      return {};
    case MotionKind::step_alpha: {
      const Real angle = motion.amplitude * radians_per_degree;
      const auto before = initial_loads(history);
      auto estimated = step_derivatives(force_history(history, 1), motion.kind, before, angle);
      add_amplitude(estimated, angle,
                    std::max(incidence_before(history), incidence_of_loads(before, estimated)));
      add_bends(estimated);
      return {std::move(estimated),
              fmt::format("step of {} degrees in alpha{}", motion.amplitude, at_incidence(history))};
    }
    case MotionKind::step_q: {
      auto estimated =
          step_derivatives(force_history(history, 1), motion.kind, initial_loads(history), motion.amplitude);
      add_amplitude(estimated, motion.amplitude, incidence_before(history));
      add_bends(estimated);
      return {std::move(estimated), fmt::format("step of {} in q", motion.amplitude)};
    }
    case MotionKind::ramp_alpha: {
      const auto before = initial_loads(history);
      auto estimated = ramp_derivatives(force_history(history, 1), before, history.column("alpha").front(),
                                        ramp_transient * history.column("t_star").back());
      add_amplitude(estimated, motion.amplitude * radians_per_degree,
                    std::max(incidence_before(history), incidence_of_loads(before, estimated)));
      add_bends(estimated, history.column("t_star").back());
      return {std::move(estimated),
              fmt::format("ramp of {} degrees in alpha{}", motion.amplitude, at_incidence(history))};
    }
    default:
      break;
  }
  return harmonic_extraction(history, {.reduced_frequency = motion.reduced_frequency});
}

Extraction extract_from_flight(const History& history, const BodySettings& body) {
  const auto is_free = [&](FreedomKind kind) {
    return std::ranges::find(body.free, kind) != body.free.end();
  };
  const bool pitches = is_free(FreedomKind::pitch);
  if (!pitches && !is_free(FreedomKind::yaw)) return {};
  Extraction out;
  const auto& time = history.column("t_star");
  out.decay = fit_decay(time, history.column(pitches ? "alpha" : "beta"), time[1] - time[0]);
  if (pitches && body.free.size() == 1) {
    out.estimated = free_pitch_derivatives(force_history(history, 0), history.column("q"), *out.decay);
    add_bends(out.estimated);
    out.method = fmt::format("free pitch, k = {:.4g}", out.decay->frequency.value);
  }
  return out;
}

std::pair<std::size_t, std::size_t> fitted_rows(const History& history) {
  const auto& motion = history.info.motion;
  const auto& time = history.column("t_star");
  Real start = 0;
  if (is_harmonic(motion.kind)) start = discarded_cycles * 2 * pi / motion.reduced_frequency;
  if (motion.kind == MotionKind::ramp_alpha) start = ramp_transient * time.back();
  const auto first = std::ranges::lower_bound(time, (1 - 1e-9) * start) - time.begin();
  return {static_cast<std::size_t>(first), time.size()};
}

Extraction derivatives_so_far(const History& history) {
  const auto& motion = history.info.motion;
  try {
    if (!is_harmonic(motion.kind)) return extract_derivatives(history);
    const Real cycles = history.column("t_star").back() * motion.reduced_frequency / (2 * pi);
    // Half a cycle at least; what is more goes to the start that is left out, up to the final fit's, then to
    // the window, up to the latest cycle: the cost must not grow with the record.
    HarmonicBasis basis{.reduced_frequency = motion.reduced_frequency, .least_cycles = 0.5};
    if (cycles < basis.least_cycles + least_discarded) return {};
    basis.discarded_cycles =
        std::max(cycles - 1, std::min(cycles - basis.least_cycles, basis.discarded_cycles));
    if (cycles < basis.discarded_cycles + 1 - 1e-6) basis.harmonics = 1;
    return harmonic_extraction(history, basis);
  } catch (const InputError&) {
    return {};  // not enough of it yet
  }
}

}  // namespace alphadot
