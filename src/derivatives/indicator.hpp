// Where on the mesh the error of a derivative is made: what a mesh is adapted by.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "derivatives/adjoint.hpp"

namespace alphadot {

/// The derivative D of a load J by a flight variable as a chain of equations: the steady flow, R(W) = 0, its
/// response to the variable's angle or rotation and those to rates,
///   A U_0 + R_c = 0,  A U_1 + M U_0 = 0,  ...  up to U_n,  A = dR/dW, M = V dQ/dW, Q conserved,
/// and D = J_W U_n (+ J_c when n = 0). Refers to fields that must outlive it.
struct DerivativeChain {
  std::string name;
  std::vector<Load> weights;                                     ///< J, of every patch's load
  ConditionsChange change;                                       ///< c of U_0
  std::vector<std::span<const Primitive<Real>>> responses = {};  ///< U_0 ... U_n, [owned_cells] each
  /// y_0 ... y_n, [owned_cells] each: A^T y_0 = J_W^T and A^T y_k = -M^T y_(k-1).
  std::vector<std::span<const Conserved<Real>>> adjoints = {};
};

struct Indicator {
  std::string name;
  Real relative_residual = 1;  ///< of the solve for xi, as Adjoint has it
  int iterations = 0;
  /// xi, [owned_cells]: a defect d of the steady flow, R(W) + d = 0, changes D by -xi . d.
  std::vector<Conserved<Real>> steady_adjoint;
  /// [owned_cells] What the dissipation on a cell's faces may do to D: half the sum of the magnitudes, for
  /// every equation of the chain, of the dissipation on a face (that of the response: its change along it)
  /// times the difference of the equation's adjoint across. An equation's dissipation falls with the square
  /// of the spacing and the difference with the spacing, so that this falls as volume times spacing squared.
  std::vector<Real> of_cells;
};

/// Of each of the chains about the flow of `iteration`, steady under `conditions`; `solver` is about the
/// same.
///
/// A defect in the equation of U_(n-k) does -y_k to D. What one of the steady flow does needs one more
/// adjoint a chain,
///   A^T xi = -sum_k d/de [A^T y_k - (k = 0) J_W^T + (k < n) M^T y_k at W + e U]
/// with U = U_(n-k) in the first two and U_(n-k-1) in the last, by central differences of transposed products
/// on both sides of the flow. Nothing when the solver was told to stop. Collective.
std::vector<Indicator> indicators(ImplicitIteration& iteration, const Conditions<Real>& conditions,
                                  AdjointSolver& solver, std::span<const DerivativeChain> chains);

/// [owned_cells] One for several derivatives: the mean of their shares of each one's sum over all ranks.
/// Collective.
std::vector<Real> joined(std::span<const Indicator> indicators, const Communicator& comm);

}  // namespace alphadot
