// Linear response of a steady flow to small changes of its conditions: the exact limit of low frequency.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "derivatives/derivative_basis.hpp"
#include "linear/tangent.hpp"
#include "march/implicit_iteration.hpp"

namespace alphadot {

/// One linear problem A U = -(dR/dc) - V dU_rate/dt about a steady flow, A = dR/dW. With the semi-discrete
/// equations V dU/dt + R(W, c) = 0 and a slow change c(t), W = W0 + W_c c + W_cdot dc/dt + ...:  A W_c = -R_c
/// and A W_cdot = -V (dU/dW) W_c. No time step, frequency or amplitude enters.
struct SensitivityProblem {
  std::string name;
  ConditionsChange change;  ///< c; zero for the response to a rate
  /// W_c of the quantity whose rate this is, [owned_cells]; or empty.
  std::span<const Primitive<Real>> rate = {};
  Real rate_error = 0;      ///< relative error of W_c, which reaches W_cdot too
  Real further_orders = 0;  ///< decades beyond those of the settings, for a response whose rate is wanted
  /// Added to the left side, [owned_cells]; or empty. The steady residual makes U a step of Newton's method.
  std::span<const Conserved<Real>> defect = {};
  /// What the loads of every patch change by while the flow is held, of this rank only; or empty.
  std::span<const Load> own_loads = {};
  /// What the solution is looked for from, [owned_cells]; or empty for zero. The decades then count from its
  /// own residual.
  std::span<const Primitive<Real>> guess = {};
};

struct Sensitivity {
  std::string name;
  std::vector<Primitive<Real>> field;  ///< W_c, [owned_cells]
  std::vector<Load> loads;             ///< change of the load of every patch, over all ranks
  std::vector<Load> loads_error;       ///< how far they may be from those of the exact solution
  Load total;
  Load total_error;  ///< how far the total may be from that of the exact solution of the linear problem
  Real relative_error = 0;     ///< the largest of them beside the size of the total
  Real relative_residual = 1;  ///< |D (A U + b)| / |D b|, D as in cell_scaling.hpp
  int iterations = 0;
};

/// Solves linear problems about one steady flow, up to three at a time with one differentiated residual,
/// preconditioned by (or, for the method `march`, iterated with) the implicit scheme of `iteration`. Those
/// that are solved together share their directions.
class SensitivitySolver {
 public:
  /// The flow of `iteration` must be steady under `conditions`. `go_on`, when given, is asked after each
  /// linear iteration, on every rank. Collective.
  SensitivitySolver(ImplicitIteration& iteration, const Conditions<Real>& conditions,
                    const DerivativeSettings& settings, std::function<bool()> go_on = {});

  /// From now on the problems leave the limiter's reaction out: its factors stay those of the steady flow.
  void hold_limiter() { basis_.linearisation.hold_limiter(); }

  /// Diagonal of the box around the body, in the mesh's scaled unit.
  Real body_size() const { return basis_.body_size; }

  /// Nothing when `go_on` said no. Throws DivergedError when a march grows: the steady state then hides an
  /// unstable cell. Collective.
  std::vector<Sensitivity> solve(const std::vector<SensitivityProblem>& problems);

  /// [problems][boundary_faces] change of the loads of faces with the solutions of some problems, but for
  /// what they change by while the flow is held. Collective.
  std::vector<std::vector<Load>> face_loads(const std::vector<SensitivityProblem>& problems,
                                            const std::vector<std::span<const Primitive<Real>>>& solutions);

 private:
  DerivativeBasis basis_;
};

}  // namespace alphadot
