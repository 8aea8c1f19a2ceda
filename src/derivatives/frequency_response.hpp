// Linear response of a steady flow to conditions that oscillate: the frequency domain.
#pragma once

#include <array>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "derivatives/derivative_basis.hpp"
#include "linear/tangent.hpp"
#include "march/implicit_iteration.hpp"

namespace alphadot {

/// One linear problem (A + i omega M) U = -(dR/dc) about a steady flow, A = dR/dW and M = V dU/dW: with the
/// semi-discrete equations V dU/dt + R(W, c) = 0 and c = c0 + change exp(i omega t), W = W0 + U exp(i omega
/// t). No time step and no amplitude enters. omega -> 0 gives the responses of sensitivity.hpp: the real part
/// that to the change, the imaginary one omega times that to its rate (K. C. Hall & E. F. Crawley, AIAA
/// Journal 27, 1989, 777).
struct FrequencyProblem {
  std::string name;
  ConditionsChange change;  ///< c
  Real omega;               ///< rad per unit of time
  /// What the solution is looked for from, real part and then imaginary one, [2 owned_cells]; or empty for
  /// zero.
  std::span<const Primitive<Real>> guess = {};
  Real inherited_error = 0;  ///< relative, of the flow that the problem is about
};

struct FrequencyResponse {
  std::vector<Primitive<Real>> field;  ///< U, real part and then imaginary one, [2 owned_cells]
  std::array<std::vector<Load>, 2> loads, loads_error;  ///< of every patch, over all ranks
  std::array<Load, 2> total, total_error;               ///< real, imaginary; as those of a Sensitivity
  Real relative_residual = 1;                           ///< |D (A U + i omega M U + b)| / |D b|
  int iterations = 0;
};

/// Solves such problems one after the other by GMRES over the complex numbers, preconditioned by the implicit
/// scheme of `iteration` for either part.
class FrequencySolver {
 public:
  /// The flow of `iteration` must be steady under `conditions`. Of `settings` all but the method count;
  /// `go_on`, when given, is asked after each linear iteration, on every rank. Collective.
  FrequencySolver(ImplicitIteration& iteration, const Conditions<Real>& conditions,
                  const DerivativeSettings& settings, std::function<bool()> go_on = {});

  /// False when `go_on` said no. Throws DivergedError when the solution leaves the numbers. Collective.
  bool solve(const FrequencyProblem& problem, FrequencyResponse& out);

 private:
  DerivativeBasis basis_;
};

}  // namespace alphadot
