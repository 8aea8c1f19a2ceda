#include "analysis/harmonic_fit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>

#include "analysis/least_squares.hpp"
#include "core/error.hpp"

namespace alphadot {

Estimate FittedAmplitude::estimate() const {
  return {value, std::hypot(residual, half_cycles) + samples};
}

namespace {

using Size = Eigen::Index;
using Eigen::VectorXd;

[[noreturn]] void refuse(const std::string& what, const std::string& remedy) {
  throw InputError("", 0, "harmonic fit: " + what, remedy);
}

/// The samples after the discarded start, which ends at `start`.
struct Window {
  Real start = 0, cycles = 0;
  VectorXd time, y, weights, bounds;
};

Eigen::Map<const VectorXd> tail_of(std::span<const Real> values, std::ptrdiff_t first) {
  const auto tail = values.subspan(static_cast<std::size_t>(first));
  return {tail.data(), static_cast<Size>(tail.size())};
}

/// Half the distance between each sample's neighbours: the trapezoidal rule.
VectorXd step_weights(const VectorXd& time) {
  const Size n = time.size();
  VectorXd weights(n);
  for (Size i = 0; i < n; ++i)
    weights(i) = (time(std::min(i + 1, n - 1)) - time(std::max<Size>(i - 1, 0))) / 2;
  return weights;
}

Window window_of(const HarmonicBasis& basis, std::span<const Real> time, std::span<const Real> y,
                 std::span<const Real> weights, std::span<const Real> bounds) {
  const auto same_size = [&](std::span<const Real> values) {
    return values.empty() || values.size() == time.size();
  };
  if (y.size() != time.size() || !same_size(weights) || !same_size(bounds))
    refuse("time, signal, weights and bounds differ in length", "give one of each a sample");
  const Real period = 2 * pi / basis.reduced_frequency;
  Window window;
  window.start = basis.discarded_cycles * period;
  window.cycles = (time.empty() ? 0.0 : time.back()) / period - basis.discarded_cycles;
  if (window.cycles < basis.least_cycles - 1e-6)
    refuse(fmt::format("the history holds {:.2f} cycles, of which the first {:.2f} are discarded",
                       window.cycles + basis.discarded_cycles, basis.discarded_cycles),
           fmt::format("set unsteady.cycles = {:g} or more", basis.discarded_cycles + basis.least_cycles));
  // Round-off in the times must not decide whether the sample on the border belongs to the window.
  const auto first = std::ranges::lower_bound(time, window.start - 1e-9 * period) - time.begin();
  window.time = tail_of(time, first);
  window.y = tail_of(y, first);
  const Size n = window.time.size();
  Real widest_step = window.time(0) - window.start;
  for (Size i = 1; i < n; ++i) widest_step = std::max(widest_step, window.time(i) - window.time(i - 1));
  // Round-off in the times must not decide here either.
  if (widest_step * basis.harmonics * steps_per_harmonic > (1 - 1e-9) * period)
    refuse(
        fmt::format("a time step of {:.3f} cycles is too long for multiple {} of the frequency",
                    widest_step / period, basis.harmonics),
        fmt::format("set unsteady.steps_per_cycle = {} or more", steps_per_harmonic * basis.harmonics + 1));
  window.weights = weights.empty() ? step_weights(window.time) : VectorXd(tail_of(weights, first));
  window.bounds = bounds.empty() ? VectorXd(VectorXd::Zero(n)) : VectorXd(tail_of(bounds, first));
  return window;
}

void check(const HarmonicBasis& basis, std::span<const Real> time, std::span<const Real> y) {
  if (!(basis.reduced_frequency > 0))
    refuse("the reduced frequency is not positive", "give k = omega l / 2V");
  if (basis.harmonics < 1) refuse("fewer than one harmonic asked for", "ask for 1 or more");
  const auto finite = [](Real value) { return std::isfinite(value); };
  if (!std::ranges::all_of(y, finite) || !std::ranges::all_of(time, finite))
    refuse("the signal or its times are not finite", "look for the step at which the run diverged");
  if (std::ranges::adjacent_find(time, std::ranges::greater_equal{}) != time.end())
    refuse("the times do not increase", "remove repeated steps, as after a restart");
}

/// Columns: 1, sin, cos, sin 2, cos 2, ... [, t* in cycles].
Eigen::MatrixXd columns(const HarmonicBasis& basis, const VectorXd& time) {
  Eigen::MatrixXd matrix(time.size(), 1 + 2 * basis.harmonics + (basis.drift ? 1 : 0));
  matrix.col(0).setOnes();
  const Eigen::ArrayXd angle = basis.reduced_frequency * time.array() + basis.phase;
  for (int n = 1; n <= basis.harmonics; ++n) {
    matrix.col(2 * n - 1) = (n * angle).sin();
    matrix.col(2 * n) = (n * angle).cos();
  }
  if (basis.drift) matrix.rightCols<1>() = basis.reduced_frequency / (2 * pi) * time;
  return matrix;
}

/// Range over the half cycles of what each would add to the sine and cosine amplitude, over sqrt(n - 1): for
/// two half cycles their difference, for many it falls as the error of a mean does. Shows a start-up that has
/// not died out and anything else that the basis does not hold.
Eigen::Vector2d half_cycle_scatter(const HarmonicBasis& basis, const Window& window,
                                   const Eigen::MatrixXd& matrix, const VectorXd& residual) {
  const VectorXd& time = window.time;
  const Real half_period = pi / basis.reduced_frequency;
  const auto parts = static_cast<int>(2 * window.cycles + 1e-6);
  if (parts < 2) return {0, 0};
  Eigen::Matrix2Xd shift(2, parts);
  Size begin = 0;
  for (int part = 0; part < parts; ++part) {
    const Real end_time = window.start + (part + 1 - 1e-9) * half_period;
    Size end = begin;
    while (end < time.size() && (part == parts - 1 || time(end) < end_time)) ++end;
    const Size n = end - begin;
    shift.col(part) = least_squares(matrix.block(begin, 1, n, 2), residual.segment(begin, n),
                                    window.weights.segment(begin, n))
                          .parameters;
    begin = end;
  }
  return (shift.rowwise().maxCoeff() - shift.rowwise().minCoeff()) / std::sqrt(parts - 1.0);
}

}  // namespace

HarmonicFit fit_harmonics(const HarmonicBasis& basis, std::span<const Real> time, std::span<const Real> y,
                          std::span<const Real> weights, std::span<const Real> bounds) {
  check(basis, time, y);
  const Window window = window_of(basis, time, y, weights, bounds);
  const Eigen::MatrixXd matrix = columns(basis, window.time);
  const LeastSquares fit = least_squares(matrix, window.y, window.weights);

  const VectorXd random = fit.uncertainty();
  const VectorXd worst = fit.worst_case(window.bounds);
  const Eigen::Vector2d scatter = half_cycle_scatter(basis, window, matrix, fit.residual);

  HarmonicFit result;
  result.mean = {fit.parameters(0), random(0) + worst(0)};
  result.in_phase = {fit.parameters(1), random(1), scatter(0), worst(1)};
  result.out_of_phase = {fit.parameters(2), random(2), scatter(1), worst(2)};
  for (int n = 2; n <= basis.harmonics; ++n)
    result.overtones.push_back({fit.parameters(2 * n - 1), fit.parameters(2 * n)});
  if (basis.drift) result.drift = fit.parameters(matrix.cols() - 1) * basis.reduced_frequency / (2 * pi);
  result.rms = fit.rms();
  result.cycles = window.cycles;
  return result;
}

}  // namespace alphadot
