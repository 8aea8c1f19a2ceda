// Adjoints of loads about a steady flow: the sensitivity of a load to everything by one linear solve.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "derivatives/derivative_basis.hpp"
#include "linear/tangent_transpose.hpp"
#include "march/implicit_iteration.hpp"

namespace alphadot {

/// One linear problem A^T psi = (dJ/dW)^T about a steady flow R(W, c) = 0, A = dR/dW, with the functional J =
/// sum over patches of weight . load. Then dJ/dc = (partial J / partial c) - psi . R_c for any c: conditions,
/// gas, shape (Giles & Pierce 2000).
///
/// The response to a rate has the adjoint A^T chi = -V (dU/dW)^T psi instead (see SensitivityProblem): with
/// it dJ/d(dc/dt) = -chi . R_c, and so on for higher derivatives with time.
struct AdjointProblem {
  std::string name;
  std::vector<Load> weights = {};              ///< of every patch's load; none for an adjoint to a rate
  std::span<const Conserved<Real>> rate = {};  ///< psi of the functional, [owned_cells]; or empty
  Real inherited_error = 0;                    ///< relative, of psi or of the flow that the problem is about
  /// Added to A^T psi, [owned_cells]; or empty.
  std::span<const Primitive<Real>> source = {};
};

struct Adjoint {
  std::string name;
  std::vector<Conserved<Real>> field;  ///< psi, [owned_cells]
  ConditionsChange sensitivity;        ///< dJ/d(conditions), or dJ/d(their rates), over all ranks
  /// How far it may be, entry by entry, from that of the exact solution of the linear problem.
  ConditionsChange sensitivity_error;
  /// -psi . R_c for each of AdjointSolver::follow(), and how far they may be.
  std::vector<Real> products, products_error;
  Real relative_error = 0;     ///< the largest of all these beside the size of the sensitivity
  Real relative_residual = 1;  ///< |D (A^T psi - b)| / |D b|, D the inverse of wave speeds times areas
  int iterations = 0;
};

/// A change of the residual, in the cells that it changes something in.
using CellChanges = std::vector<std::pair<Index, Conserved<Real>>>;

/// Solves adjoint problems about one steady flow, up to three at a time with one transposed operator,
/// preconditioned by the transpose of the implicit scheme of `iteration`: the twin of SensitivitySolver.
class AdjointSolver {
 public:
  /// The flow of `iteration` must be steady under `conditions`. `go_on`, when given, is asked after each
  /// linear iteration, on every rank. Collective.
  AdjointSolver(ImplicitIteration& iteration, const Conditions<Real>& conditions,
                const DerivativeSettings& settings, std::function<bool()> go_on = {});

  /// From now on products of the adjoints with this change of the residual, [owned_cells], are followed as
  /// well. Cells that it leaves alone cost nothing.
  void follow(std::span<const Conserved<Real>> residual_change);

  /// Nothing when `go_on` said no. Throws DivergedError when a solution leaves the numbers, std::logic_error
  /// when the implicit scheme has no transpose. Collective.
  std::vector<Adjoint> solve(const std::vector<AdjointProblem>& problems);

  /// dJ/d(position) of every point of this rank, [points]: this rank's part of a sum over all. The adjoint is
  /// that of the load with these weights. Collective.
  std::vector<Vec3> by_points(const Adjoint& adjoint, std::span<const Load> weights);

 private:
  DerivativeBasis basis_;
  std::vector<CellChanges> residual_changes_;
};

}  // namespace alphadot
