#include "analysis/least_squares.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>

#include "core/error.hpp"

namespace alphadot {

Real LeastSquares::rms() const {
  return residual.norm() / std::sqrt(static_cast<Real>(residual.size()));
}

Eigen::VectorXd LeastSquares::uncertainty() const {
  const auto n = residual.size();
  const Real square = residual.squaredNorm();
  if (square == 0) return Eigen::VectorXd::Zero(parameters.size());
  const auto samples = static_cast<Real>(n), taken = static_cast<Real>(parameters.size());
  const Real likeness = residual.head(n - 1).dot(residual.tail(n - 1)) / square;
  // A fit removes the slow part of the errors, which lowers rho by about p / n when they are independent.
  const Real rho = std::clamp(likeness + taken / samples, 0.0, 0.95);
  const Real freedom = std::max(samples * (1 - rho) / (1 + rho) - taken, 2.0);
  const Real coverage = 2 * (1 + 1 / freedom);  // Student's t for 95 %, rounded
  return coverage * std::sqrt(square / freedom) * gain.rowwise().norm();
}

Eigen::VectorXd LeastSquares::worst_case(const Eigen::VectorXd& bounds) const {
  return gain.cwiseAbs() * bounds;
}

LeastSquares least_squares(const Eigen::MatrixXd& basis, const Eigen::VectorXd& y,
                           const Eigen::VectorXd& weights) {
  const Eigen::VectorXd root = weights.cwiseSqrt();
  const Eigen::MatrixXd weighted = root.asDiagonal() * basis;
  const Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> factors(weighted);
  if (basis.rows() <= basis.cols() || factors.rank() < basis.cols())
    throw InputError("", 0,
                     std::to_string(basis.rows()) + " samples do not determine the " +
                         std::to_string(basis.cols()) + " unknowns of a least-squares fit",
                     "give more samples, spread over the whole motion");
  LeastSquares fit;
  fit.gain = factors.pseudoInverse() * root.asDiagonal();
  fit.parameters = fit.gain * y;
  fit.residual = y - basis * fit.parameters;
  return fit;
}

}  // namespace alphadot
