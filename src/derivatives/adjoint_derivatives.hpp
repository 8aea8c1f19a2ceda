// Derivatives of the loads of a case from adjoints about its steady flow: the twin of linear_derivatives().
#pragma once

#include <map>
#include <string>
#include <vector>

#include "analysis/table.hpp"
#include "derivatives/functional.hpp"
#include "derivatives/linear_derivatives.hpp"
#include "derivatives/stream_change.hpp"
#include "derivatives/surface_sensitivity.hpp"

namespace alphadot {

/// By the name of their functional.
using Adjoints = std::map<std::string, Adjoint>;

/// Every load that symmetry leaves.
std::vector<Functional> all_functionals(const FlightCondition& settings);

class AdjointDerivatives {
 public:
  /// About the steady flow that `flow` has marched to. Collective. Throws InputError when the implicit scheme
  /// of the case has no transpose. The flow must outlive the object.
  AdjointDerivatives(FlowCase& flow, std::vector<Functional> functionals, SolveObserver observer = {});

  /// Solves for the adjoints of the functionals, and for those that they rest on, but for those that
  /// `adjoints` has already, which takes the others; the observer is told of each group. False when the
  /// observer ended it. Collective. Throws DivergedError.
  bool solve(Adjoints& adjoints);

  /// What a table says of the functionals' derivatives: by alpha, q, beta, p and r or by the rates of the
  /// angles, by controls, and by Mach number and gamma with incidence and reduced rates held. Those that rest
  /// on something that did not reach what was asked for are not converged; adds that to `shortfalls`. Of a
  /// flow that has not come far to rest none is: what it leaves in the derivatives is in no uncertainty here.
  std::vector<TableRow> rows(const Adjoints& adjoints, std::vector<std::string>& shortfalls) const;

  /// By the place of every point of the walls, of a functional that is none of rates. Collective.
  SurfaceSensitivity by_shape(const Functional& functional, const Adjoints& adjoints);

  const std::vector<Functional>& functionals() const { return functionals_; }

 private:
  Estimate by_control(const Functional& functional, const Adjoint& adjoint, Variable control) const;
  std::vector<std::string> unconverged(const Adjoints& adjoints, std::vector<std::string>& shortfalls) const;

  FlowCase& flow_;
  std::vector<Functional> functionals_;
  SolveObserver observer_;
  std::vector<StreamChange> stream_;
  std::vector<Variable> controls_;
  std::vector<std::vector<Load>> control_loads_;  // [controls][patches] at a held flow, over all ranks
  AdjointSolver solver_;
};

/// Throws InputError when the implicit scheme of a case has no transpose.
void check_has_transpose(const Case& settings);

}  // namespace alphadot
