#include "analysis/ramp.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "analysis/least_squares.hpp"
#include "core/error.hpp"
#include "core/fit_needs.hpp"

namespace alphadot {

namespace {

using Size = Eigen::Index;
using Eigen::VectorXd;

/// The part of a series from `first` on.
VectorXd tail_of(const std::vector<Real>& values, Size first) {
  const auto size = static_cast<Size>(values.size());
  return Eigen::Map<const VectorXd>(values.data(), size).tail(size - first);
}

LeastSquares fit_line(const VectorXd& x, const VectorXd& y) {
  Eigen::MatrixXd basis(x.size(), 2);
  basis << x, VectorXd::Ones(x.size());
  return least_squares(basis, y, VectorXd::Ones(x.size()));
}

/// By how much more of a term c x^2 a line over a window takes into its slope and its intercept than the
/// lines of the window's halves differ, at least once. With m the middle of the window and h its length the
/// line is 2 m c x - (m^2 - h^2 / 12) c, and those of the halves differ by h c and h m c. A little is for
/// kinks.
std::array<Real, 2> curvature_shares(const VectorXd& x) {
  const Real m = std::abs(x(0) + x(x.size() - 1)) / 2, h = std::abs(x(x.size() - 1) - x(0));
  constexpr Real of_kinks = 1.15;
  return {of_kinks * std::max(2 * m / h, Real{1}),
          of_kinks * std::max((m * m - h * h / 12) / (h * m), Real{1})};
}

/// Slope and intercept of y against x, x in units of its range: values, uncertainties of the fit, and worst
/// cases of the bounds.
struct Line {
  std::array<Real, 2> value, fit, inner;
};

Line line_with_uncertainty(const VectorXd& x, const VectorXd& y, const VectorXd& bounds) {
  const Size half = x.size() / 2;
  const LeastSquares whole = fit_line(x, y);
  const VectorXd change =
      fit_line(x.tail(half), y.tail(half)).parameters - fit_line(x.head(half), y.head(half)).parameters;
  const VectorXd random = whole.uncertainty(), worst = whole.worst_case(bounds);
  const auto shares = curvature_shares(x);
  Line out;
  for (int i = 0; i < 2; ++i) {
    const auto n = static_cast<std::size_t>(i);
    out.value[n] = whole.parameters(i);
    out.fit[n] = std::hypot(random(i), shares[n] * change(i));
    out.inner[n] = worst(i);
  }
  return out;
}

}  // namespace

EstimatedDerivatives ramp_derivatives(const ForceHistory& history, const Coefficients& initial,
                                      Real initial_angle, Real transient) {
  history.validate();
  const auto first = std::ranges::lower_bound(history.time, transient) - history.time.begin();
  const auto samples = static_cast<Size>(history.time.size()) - first;
  if (samples < least_ramp_samples || history.angle.empty())
    throw InputError("", 0,
                     fmt::format("ramp: {} samples after the transient of t* = {:g}", samples, transient),
                     "set unsteady.steps to more, or compute a longer ramp");
  const VectorXd time = tail_of(history.time, first);
  const VectorXd angle = tail_of(history.angle, first).array() - initial_angle;
  const Real span = time(samples - 1) - time(0), rise = angle(samples - 1) - angle(0);
  const Real rate = rise / span;
  const VectorXd line = angle(0) + rate * (time.array() - time(0));
  if (!((angle - line).lpNorm<Eigen::Infinity>() <= 1e-6 * std::abs(rise)) || rise == 0)
    throw InputError("", 0, "ramp: the angle does not grow at a constant rate after the transient",
                     "end the record where the ramp ends");

  EstimatedDerivatives out;
  DerivativeSetOf<Real> fit, inner;
  for (int c = 0; c < initial.size(); ++c) {
    const VectorXd y = tail_of(history.load(c), first).array() - initial[c];
    const VectorXd bounds =
        history.bounds.empty() ? VectorXd(VectorXd::Zero(samples)) : tail_of(history.bound(c), first);
    // The fit's columns are of order one, whatever the rise in radians.
    const Line line_fit = line_with_uncertainty(1 / rise * angle, y, bounds);
    const std::array columns{std::pair{Variable::alpha, rise}, std::pair{Variable::alphadot, rate}};
    for (std::size_t i = 0; i < columns.size(); ++i) {
      const auto [variable, unit] = columns[i];
      out.derivatives[variable][c].value = line_fit.value[i] / unit;
      fit[variable][c] = line_fit.fit[i] / std::abs(unit);
      inner[variable][c] = line_fit.inner[i] / std::abs(unit);
    }
  }
  out.add("fit", fit);
  out.add("inner", inner);
  return out;
}

}  // namespace alphadot
