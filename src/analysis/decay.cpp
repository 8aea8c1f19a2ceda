#include "analysis/decay.hpp"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <optional>

#include "analysis/least_squares.hpp"
#include "core/error.hpp"

namespace alphadot {

namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

[[noreturn]] void refuse(const std::string& what) {
  throw InputError("", 0, "free motion: " + what, "set unsteady.duration so that it swings twice at least");
}

/// -damping + i k of y'' + 2 damping y' + ... = 0, from three samples at a time; nothing where it does not
/// swing.
std::optional<std::complex<Real>> predicted_root(const VectorXd& time, const VectorXd& y) {
  const auto n = y.size();
  // Samples far enough apart that round-off matters little, many of them to a cycle.
  for (Eigen::Index stride = std::max<Eigen::Index>(n / 24, 1); stride >= 1; stride /= 2) {
    const auto rows = n - 2 * stride;
    if (rows < 6) continue;
    const Real shift = y.mean(), size = std::max((y.array() - shift).abs().maxCoeff(), 1e-300);
    const VectorXd z = (y.array() - shift) / size;
    MatrixXd basis(rows, 3);
    basis << z.segment(stride, rows), z.head(rows), VectorXd::Ones(rows);
    const VectorXd c = basis.colPivHouseholderQr().solve(z.tail(rows));
    // z(n + 1) = c0 z(n) + c1 z(n - 1): roots r of r^2 - c0 r - c1.
    const Real under = c(0) * c(0) / 4 + c(1);
    if (!(under < 0)) continue;
    const std::complex<Real> root{c(0) / 2, std::sqrt(-under)};
    return std::log(root) / (time(stride) - time(0));
  }
  return std::nullopt;
}

struct Fit {
  std::array<Real, 3> value, random;  // damping, frequency, mean
  Real rms;
  Real cosine, sine;  // of the swing at the first sample
};

/// Gauss and Newton's iteration; time is zero at the first sample.
std::optional<Fit> fit_from(std::complex<Real> root, const VectorXd& time, const VectorXd& y) {
  constexpr int most_iterations = 50;
  Real damping = -root.real(), k = root.imag();
  const VectorXd weights = VectorXd::Ones(time.size());
  for (int iteration = 0; iteration < most_iterations; ++iteration) {
    const VectorXd envelope = (-damping * time.array()).exp();
    MatrixXd basis(time.size(), 3);
    basis << weights, (envelope.array() * (k * time.array()).cos()).matrix(),
        (envelope.array() * (k * time.array()).sin()).matrix();
    const VectorXd linear = basis.colPivHouseholderQr().solve(y);
    // Columns of order one: changes of damping and frequency in units of the frequency.
    const VectorXd swing = linear(1) * basis.col(1) + linear(2) * basis.col(2);
    const VectorXd quadrature = linear(2) * basis.col(1) - linear(1) * basis.col(2);
    MatrixXd all(time.size(), 5);
    all << basis, (-k * time.array() * swing.array()).matrix(),
        (k * time.array() * quadrature.array()).matrix();
    const LeastSquares fit = least_squares(all, y, weights);
    const Real damping_change = k * fit.parameters(3), k_change = k * fit.parameters(4);
    damping += damping_change;
    k += k_change;
    if (!std::isfinite(damping) || !(k > 0)) return std::nullopt;
    if (std::abs(damping_change) + std::abs(k_change) > 1e-9 * k) continue;
    const VectorXd random = fit.uncertainty();
    return Fit{{damping, k, fit.parameters(0)},
               {k * random(3), k * random(4), random(0)},
               fit.rms(),
               linear(1),
               linear(2)};
  }
  return std::nullopt;
}

/// By how much the swing's size changes damping and frequency, from its second and third harmonics: of
/// y'' + k^2 (y + a y^2 + b y^3) + c y^2 y' = 0 about y = A cos k t these are -a A / 6 and b A^2 / 32 of it
/// in phase and c A^2 / (32 k) behind by a quarter, while k changes by the share 3 b A^2 / 8 - 5 a^2 A^2 / 12
/// and the damping by c A^2 / 8 (Lindstedt and Poincare).
std::array<Real, 2> changes_by_amplitude(const Fit& fit, const VectorXd& time, const VectorXd& y) {
  const auto [damping, k, mean] = fit.value;
  MatrixXd basis(time.size(), 7);
  basis.col(0).setOnes();
  for (int n = 1; n <= 3; ++n) {
    const Eigen::ArrayXd envelope = (-n * damping * time.array()).exp();
    basis.col(2 * n - 1) = envelope * (n * k * time.array()).cos();
    basis.col(2 * n) = envelope * (n * k * time.array()).sin();
  }
  const VectorXd c = basis.colPivHouseholderQr().solve(y);
  const Real amplitude = std::hypot(fit.cosine, fit.sine), phase = std::atan2(fit.sine, fit.cosine);
  const Real second = std::hypot(c(3), c(4)) / amplitude;
  const std::complex<Real> third =
      std::complex<Real>{c(5), c(6)} * std::polar(Real{1} / amplitude, -3 * phase);
  return {4 * k * std::abs(third.imag()), k * (12 * std::abs(third.real()) + 15 * second * second)};
}

VectorXd vector_of(std::span<const Real> values) {
  return Eigen::Map<const VectorXd>(values.data(), static_cast<Eigen::Index>(values.size()));
}

/// The later two thirds.
template <class Vector>
auto later(const Vector& v) {
  return v.tail(v.size() - v.size() / 3);
}

}  // namespace

Decay fit_decay(std::span<const Real> time, std::span<const Real> angle, Real time_step) {
  if (time.size() != angle.size() || !std::ranges::all_of(angle, [](Real a) { return std::isfinite(a); }))
    throw InputError("", 0, "free motion: the angle is not finite, or not one a time",
                     "look for the step at which the run diverged");
  if (time.size() < 16) refuse("too few samples");
  const VectorXd whole_time = vector_of(time), whole = vector_of(angle);
  const auto root = predicted_root(whole_time, whole);
  if (!root) refuse("the angle does not swing");
  const Real cycle = 2 * pi / root->imag();
  const auto first = std::ranges::lower_bound(time, time[0] + free_discarded_cycles * cycle) - time.begin();
  const auto n = static_cast<Eigen::Index>(time.size()) - first;
  const Real length = n > 1 ? time.back() - time[static_cast<std::size_t>(first)] : 0;
  if (length < 0.98 * least_free_cycles * cycle || n < 16)
    refuse(fmt::format("{:.2g} cycles of about t* = {:.3g} are left behind the first quarter", length / cycle,
                       cycle));
  const VectorXd t = whole_time.tail(n).array() - time[static_cast<std::size_t>(first)], y = whole.tail(n);
  const auto fit = fit_from(*root, t, y);
  if (!fit) refuse("no decaying sine fits the angle");
  const VectorXd late = later(t).array() - later(t)(0);
  const auto other = fit_from({-fit->value[0], fit->value[1]}, late, later(y));
  std::array<Estimate, 3> out;
  for (std::size_t i = 0; i < out.size(); ++i) {
    const Real change = other ? other->value[i] - fit->value[i] : fit->value[i];
    out[i] = {fit->value[i], std::hypot(fit->random[i], change)};
  }
  const auto by_amplitude = changes_by_amplitude(*fit, t, y);
  for (std::size_t i = 0; i < by_amplitude.size(); ++i) out[i] += {0, by_amplitude[i]};
  if (time_step > 0) {
    const std::complex<Real> found{-out[0].value, out[1].value};
    const std::complex<Real> exact = 2 / time_step * std::tanh(Real{0.5} * time_step * found);
    if (!(found.imag() * time_step < pi / 2)) refuse("fewer than four time steps a cycle");
    out[0] += {-(exact - found).real(), std::abs((exact - found).real())};
    out[1] += {(exact - found).imag(), std::abs((exact - found).imag())};
  }
  return {out[1], out[0], out[2], fit->rms, time.back() - length, length * fit->value[1] / (2 * pi)};
}

EstimatedDerivatives free_pitch_derivatives(const ForceHistory& history, std::span<const Real> rate,
                                            const Decay& decay) {
  history.validate();
  const auto first = std::ranges::lower_bound(history.time, decay.start) - history.time.begin();
  const auto n = static_cast<Eigen::Index>(history.time.size()) - first;
  if (n < 12 || rate.size() != history.time.size()) refuse("too few samples");
  const VectorXd alpha = vector_of(history.angle).tail(n), q = vector_of(rate).tail(n);
  const Real mean = alpha.mean(), of_alpha = (alpha.array() - mean).abs().maxCoeff(),
             of_q = q.cwiseAbs().maxCoeff();
  if (!(of_alpha > 0 && of_q > 0)) refuse("the body does not move");
  MatrixXd basis(n, 3);
  basis << VectorXd::Ones(n), ((alpha.array() - mean) / of_alpha).matrix(), q / of_q;
  const auto fit = [](const MatrixXd& columns, const VectorXd& y) {
    return least_squares(columns, y, VectorXd::Ones(y.size()));
  };
  const auto a = basis.col(1).array(), rate_column = basis.col(2).array();
  MatrixXd higher(n, 7);
  higher << basis, a.square().matrix(), (a * rate_column).matrix(), a.cube().matrix(),
      (a.square() * rate_column).matrix();
  const MatrixXd late_basis = basis.bottomRows(n - n / 3);
  const std::array columns{std::pair{Variable::alpha, of_alpha}, std::pair{Variable::q_plus_alphadot, of_q}};
  EstimatedDerivatives out;
  DerivativeSetOf<Real> of_fit, inner, of_step, amplitude;
  const Real theta = decay.frequency.value * history.time_step;
  for (int c = 0; c < Coefficients::size(); ++c) {
    const VectorXd y = vector_of(history.load(c)).tail(n);
    const VectorXd bounds =
        history.bounds.empty() ? VectorXd(VectorXd::Zero(n)) : VectorXd(vector_of(history.bound(c)).tail(n));
    const LeastSquares whole = fit(basis, y);
    const VectorXd change = fit(late_basis, later(y)).parameters - whole.parameters,
                   random = whole.uncertainty(), worst = whole.worst_case(bounds),
                   small = fit(higher, y).parameters;  // of a small motion
    for (std::size_t i = 0; i < columns.size(); ++i) {
      const auto [variable, unit] = columns[i];
      const auto column = static_cast<Eigen::Index>(i) + 1;
      out.derivatives[variable][c].value = whole.parameters(column) / unit;
      of_fit[variable][c] = std::hypot(random(column), change(column)) / unit;
      inner[variable][c] = worst(column) / unit;
      amplitude[variable][c] = std::abs(small(column) - whole.parameters(column)) / unit;
      of_step[variable][c] = i == 0 ? 0 : theta * theta / 3 * std::abs(whole.parameters(column)) / unit;
    }
  }
  out.add("fit", of_fit);
  out.add("inner", inner);
  out.add("time_step", of_step);
  out.add("amplitude", amplitude);
  return out;
}

}  // namespace alphadot
