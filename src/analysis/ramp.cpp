#include "analysis/ramp.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "analysis/least_squares.hpp"
#include "core/error.hpp"

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

/// Slope and intercept of y against x, x in units of its range.
struct Line {
  Estimate slope, intercept;
};

Line line_with_uncertainty(const VectorXd& x, const VectorXd& y, const VectorXd& bounds) {
  const Size half = x.size() / 2;
  const LeastSquares whole = fit_line(x, y);
  const VectorXd change =
      fit_line(x.tail(half), y.tail(half)).parameters - fit_line(x.head(half), y.head(half)).parameters;
  const VectorXd random = whole.uncertainty(), worst = whole.worst_case(bounds);
  const auto estimate = [&](Size i) {
    return Estimate{whole.parameters(i), std::hypot(random(i), change(i)) + worst(i)};
  };
  return {estimate(0), estimate(1)};
}

}  // namespace

DerivativeSet ramp_derivatives(const ForceHistory& history, const Coefficients& initial, Real initial_angle,
                               Real transient) {
  history.validate();
  const auto first = std::ranges::lower_bound(history.time, transient) - history.time.begin();
  const auto samples = static_cast<Size>(history.time.size()) - first;
  if (samples < 8 || history.angle.empty())
    throw InputError("", 0,
                     fmt::format("ramp: {} samples after the transient of t* = {:g}", samples, transient),
                     "compute a longer ramp or shorter steps");
  const VectorXd time = tail_of(history.time, first);
  const VectorXd angle = tail_of(history.angle, first).array() - initial_angle;
  const Real span = time(samples - 1) - time(0), rise = angle(samples - 1) - angle(0);
  const Real rate = rise / span;
  const VectorXd line = angle(0) + rate * (time.array() - time(0));
  if (!((angle - line).lpNorm<Eigen::Infinity>() <= 1e-6 * std::abs(rise)) || rise == 0)
    throw InputError("", 0, "ramp: the angle does not grow at a constant rate after the transient",
                     "end the record where the ramp ends");

  CoefficientsOf<Estimate> slope, rate_part;
  for (int c = 0; c < initial.size(); ++c) {
    const VectorXd y = tail_of(history.load(c), first).array() - initial[c];
    const VectorXd bounds =
        history.bounds.empty() ? VectorXd(VectorXd::Zero(samples)) : tail_of(history.bound(c), first);
    // The fit's columns are of order one, whatever the rise in radians.
    const Line fit = line_with_uncertainty(1 / rise * angle, y, bounds);
    slope[c] = 1 / rise * fit.slope;
    rate_part[c] = 1 / rate * fit.intercept;
  }
  return {{Variable::alpha, slope}, {Variable::alphadot, rate_part}};
}

}  // namespace alphadot
