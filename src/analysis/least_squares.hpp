// Weighted linear least squares that keeps what is needed to judge its result.
#pragma once

#include <Eigen/Core>

#include "core/types.hpp"

namespace alphadot {

/// Result of y ~ basis * parameters for n samples and p parameters.
struct LeastSquares {
  Eigen::VectorXd parameters;  ///< p
  Eigen::MatrixXd gain;        ///< p x n: parameters = gain * y, the sensitivity to every sample
  Eigen::VectorXd residual;    ///< n: y - basis * parameters

  Real rms() const;
  /// p: about 95 % of each parameter. The size of the errors is taken from the residual, and so is their
  /// likeness from one sample to the next, rho (first-order autoregressive): n samples in a row count as n (1
  /// - rho) / (1 + rho) independent ones. Needs samples in the order of time.
  Eigen::VectorXd uncertainty() const;
  /// p: largest change of each parameter when sample i is off by at most bounds(i), whatever the signs.
  Eigen::VectorXd worst_case(const Eigen::VectorXd& bounds) const;
};

/// Minimises sum of weights (n, positive) times squared residuals; basis is n x p with columns of order one.
/// Throws InputError when the samples do not determine the parameters.
LeastSquares least_squares(const Eigen::MatrixXd& basis, const Eigen::VectorXd& y,
                           const Eigen::VectorXd& weights);

}  // namespace alphadot
