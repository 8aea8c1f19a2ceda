#include "analysis/indicial.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <vector>

#include "core/error.hpp"

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
  if (time.size() < 12)
    throw InputError("", 0, "step response: fewer than 12 samples", "take more time steps");
  if (!std::ranges::all_of(y, finite) || !std::ranges::all_of(time, finite))
    throw InputError("", 0, "step response: the signal or its times are not finite",
                     "look for the step at which the run diverged");
  if (time[0] < 0 || std::ranges::adjacent_find(time, std::ranges::greater_equal{}) != time.end())
    throw InputError("", 0, "step response: the times do not increase from zero",
                     "remove repeated steps, as after a restart");
}

}  // namespace

StepFit fit_step(std::span<const Real> time, std::span<const Real> y, std::span<const Real> bounds) {
  check(time, y, bounds);
  const Polyline response(time, y, 1);
  const Real end = time.back(), h = end / 10;
  std::array<Real, 3> mean;
  for (int i = 0; i < 3; ++i) mean[i] = response.integral(end - (3 - i) * h, end - (2 - i) * h) / h;

  const Real change = mean[2] - mean[1];
  const Real rho = mean[1] != mean[0] ? change / (mean[1] - mean[0]) : 0;
  const Real series = rho > 0 && rho < 0.8 ? rho / (1 - rho) : 0;  // rho + rho^2 + ...
  const Real final = mean[2] + change * series;
  const auto [low, high] = std::minmax({mean[0], mean[1], mean[2], final});
  StepFit fit;
  fit.final = {final, std::max(1.5 * (high - low), rho >= 0.8 ? 9 * std::abs(change) : 0)};
  fit.tail = change * series * h * series;

  const auto deficit = [&](const Polyline& line) { return fit.final.value * end - line.integral(0, end); };
  const Real whole = deficit(response), halved = deficit(Polyline(time, y, 2));
  fit.deficit = {whole + fit.tail,
                 fit.final.uncertainty * end + std::abs(fit.tail) + std::abs(whole - halved)};
  if (!bounds.empty()) {
    const Real worst = *std::ranges::max_element(bounds);
    fit.final.uncertainty += worst;
    fit.deficit.uncertainty += worst * end + Polyline(time, bounds, 1).integral(0, end);
  }
  return fit;
}

DerivativeSet step_derivatives(const ForceHistory& history, MotionKind motion, const Coefficients& initial,
                               Real step) {
  if (motion != MotionKind::step_alpha && motion != MotionKind::step_q)
    throw InputError("", 0, "step response: the motion is not a step", "use step_alpha or step_q");
  if (step == 0) throw InputError("", 0, "step response: the step is zero", "give motion.amplitude a value");
  history.validate();
  CoefficientsOf<Estimate> slope, rate;
  for (int c = 0; c < initial.size(); ++c) {
    const StepFit fit = fit_step(history.time, history.load(c), history.bound(c));
    slope[c] = 1 / step * (fit.final - Estimate{initial[c], 0});
    rate[c] = -1 / step * fit.deficit;
  }
  if (motion == MotionKind::step_q) return {{Variable::q, slope}};
  return {{Variable::alpha, slope}, {Variable::alphadot, rate}};
}

}  // namespace alphadot
