// The flow that a steady march would have reached, as far as one step tells.
#pragma once

#include <vector>

#include "derivatives/sensitivity.hpp"

namespace alphadot {

/// Moves the flow of an iteration by one step of Newton's method, -A^-1 R with the residual that is left, its
/// limiter free as it is in a motion, and back at the end of its life. What a derivative changes by meanwhile
/// is what the steady residual does to it, to first order.
class NewtonStep {
 public:
  /// `solver` is about the present flow. Changes of density and pressure are capped as in a march.
  /// Collective.
  NewtonStep(ImplicitIteration& iteration, const Conditions<Real>& conditions, SensitivitySolver& solver);
  ~NewtonStep();
  NewtonStep(const NewtonStep&) = delete;
  NewtonStep& operator=(const NewtonStep&) = delete;
  /// The solver was asked to stop: the flow has not moved.
  bool was_stopped() const { return was_stopped_; }

 private:
  ImplicitIteration& iteration_;
  std::vector<Primitive<Real>> before_;  // [total_cells]
  bool was_stopped_ = false;
};

}  // namespace alphadot
