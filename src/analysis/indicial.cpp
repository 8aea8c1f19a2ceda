#include "analysis/indicial.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "core/fit_needs.hpp"

namespace alphadot {

namespace {

/// A response as straight lines between samples, level before the first one.
struct Polyline {
  std::vector<Real> time{0}, value;

  Polyline(std::span<const Real> times, std::span<const Real> y, std::size_t stride) {
    value.push_back(y[0]);
    // Counted from the end, so that every stride keeps the last sample.
    for (std::size_t i = (times.size() - 1) % stride; i < times.size(); i += stride) {
      time.push_back(times[i]);
      value.push_back(y[i]);
    }
  }

  /// Integral from time a to time b.
  Real integral(Real a, Real b) const {
    Real sum = 0;
    for (std::size_t i = 1; i < time.size(); ++i) {
      const Real left = std::max(a, time[i - 1]), right = std::min(b, time[i]);
      if (right > left) sum += (right - left) * (at(i, left) + at(i, right)) / 2;
    }
    return sum;
  }

 private:
  /// Value at time t on the line that ends at sample i.
  Real at(std::size_t i, Real t) const {
    const Real share = (t - time[i - 1]) / (time[i] - time[i - 1]);
    return value[i - 1] + share * (value[i] - value[i - 1]);
  }
};

void check(std::span<const Real> time, std::span<const Real> y, std::span<const Real> bounds) {
  const auto finite = [](Real value) { return std::isfinite(value); };
  if (time.size() != y.size() || (!bounds.empty() && bounds.size() != time.size()))
    throw InputError("", 0, "step response: times, signal and bounds differ in length",
                     "give one of each a sample");
  if (time.size() < static_cast<std::size_t>(least_step_samples))
    throw InputError("", 0, "step response: too few samples",
                     "set unsteady.steps = " + std::to_string(least_step_samples - 1) + " or more");
  if (!std::ranges::all_of(y, finite) || !std::ranges::all_of(time, finite))
    throw InputError("", 0, "step response: the signal or its times are not finite",
                     "look for the step at which the run diverged");
  if (time[0] < 0 || std::ranges::adjacent_find(time, std::ranges::greater_equal{}) != time.end())
    throw InputError("", 0, "step response: the times do not increase from zero",
                     "remove repeated steps, as after a restart");
}

bool is_monotone(const std::array<Real, 6>& values) {
  return std::ranges::is_sorted(values) || std::ranges::is_sorted(values, std::greater{});
}

/// 0 when there are no bounds.
Real largest_bound_after(Real start, std::span<const Real> time, std::span<const Real> bounds) {
  Real out = 0;
  for (std::size_t i = 0; i < bounds.size(); ++i)
    if (time[i] >= start) out = std::max(out, bounds[i]);
  return out;
}

}  // namespace

StepFit fit_step(std::span<const Real> time, std::span<const Real> y, std::span<const Real> bounds) {
  check(time, y, bounds);
  const Polyline response(time, y, 1);
  const Real end = time.back(), h = end / 10;
  std::array<Real, 6> half;  // means over half tenths
  for (int i = 0; i < 6; ++i)
    half[i] = response.integral(end - (6 - i) * h / 2, end - (5 - i) * h / 2) / (h / 2);
  std::array<Real, 3> mean;
  for (int i = 0; i < 3; ++i) mean[i] = (half[2 * i] + half[2 * i + 1]) / 2;

  const Real change = mean[2] - mean[1];
  const bool is_over =
      !is_monotone(half) || std::abs(change) <= largest_bound_after(end - 3 * h, time, bounds);
  const Real rho = mean[1] != mean[0] ? change / (mean[1] - mean[0]) : 0;
  const Real series = !is_over && rho > 0 && rho < 0.8 ? rho / (1 - rho) : 0;  // rho + rho^2 + ...
  const Real final = mean[2] + change * series;
  const auto [low, high] = std::minmax({mean[0], mean[1], mean[2], final});
  StepFit fit;
  fit.final = {final, std::max(1.5 * (high - low), rho >= 0.8 ? 9 * std::abs(change) : 0)};
  fit.tail = change * series * h * series;

  const auto deficit = [&](const Polyline& line) { return fit.final.value * end - line.integral(0, end); };
  const Real whole = deficit(response), halved = deficit(Polyline(time, y, 2));
  fit.sampling = std::abs(whole - halved);
  fit.deficit = {whole + fit.tail, fit.final.uncertainty * end + std::abs(fit.tail) + fit.sampling};
  if (!bounds.empty()) {
    fit.inner_of_final = *std::ranges::max_element(bounds);
    fit.inner_of_deficit = fit.inner_of_final * end + Polyline(time, bounds, 1).integral(0, end);
    fit.final.uncertainty += fit.inner_of_final;
    fit.deficit.uncertainty += fit.inner_of_deficit;
  }
  return fit;
}

EstimatedDerivatives step_derivatives(const ForceHistory& history, MotionKind motion,
                                      const Coefficients& initial, Real step) {
  if (motion != MotionKind::step_alpha && motion != MotionKind::step_q)
    throw InputError("", 0, "step response: the motion is not a step", "use step_alpha or step_q");
  if (step == 0) throw InputError("", 0, "step response: the step is zero", "give motion.amplitude a value");
  history.validate();
  EstimatedDerivatives out;
  DerivativeSetOf<Real> fit, inner, time_step;
  const auto add = [&](Variable variable, int c, const Estimate& found, Real inner_part, Real sampling) {
    out.derivatives[variable][c].value = found.value / step;
    fit[variable][c] = (found.uncertainty - inner_part - sampling) / std::abs(step);
    inner[variable][c] = inner_part / std::abs(step);
    time_step[variable][c] = sampling / std::abs(step);
  };
  for (int c = 0; c < initial.size(); ++c) {
    const StepFit found = fit_step(history.time, history.load(c), history.bound(c));
    const Variable slope = motion == MotionKind::step_q ? Variable::q : Variable::alpha;
    add(slope, c, found.final - Estimate{initial[c], 0}, found.inner_of_final, 0);
    if (slope == Variable::alpha)
      add(Variable::alphadot, c, -found.deficit, found.inner_of_deficit, found.sampling);
  }
  out.add("fit", fit);
  out.add("inner", inner);
  out.add("time_step", time_step);
  return out;
}

}  // namespace alphadot
