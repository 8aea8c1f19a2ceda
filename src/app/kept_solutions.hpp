// Linear solutions about a steady flow, kept in a run's checkpoints.
#pragma once

#include <atomic>
#include <functional>

#include "app/case_run.hpp"
#include "app/watchdog.hpp"
#include "derivatives/adjoint_derivatives.hpp"
#include "derivatives/frequency_derivatives.hpp"
#include "derivatives/linear_derivatives.hpp"

namespace alphadot {

/// The solutions of the checkpoint that the run goes on from, when they are about the flow that `run` has
/// marched to, under the same [derivatives]; else none. Collective.
Responses kept_responses(CaseRun& run);
Adjoints kept_adjoints(CaseRun& run);
Oscillations kept_oscillations(CaseRun& run);

/// Writes a checkpoint with the steady flow and the solutions. Collective.
void keep(CaseRun& run, Responses& responses);
void keep(CaseRun& run, Adjoints& adjoints);
void keep(CaseRun& run, Oscillations& oscillations);

/// Looks on while a run solves: requests to stop end the solves, one that hangs is noticed.
class LinearSolves {
 public:
  /// `save` writes a checkpoint. The run must outlive the object.
  LinearSolves(CaseRun& run, std::function<void()> save);
  /// Refers to this object.
  SolveObserver observer() const { return observer_; }

 private:
  std::atomic<GlobalIndex> iterations_{0};
  SolveObserver observer_;
  Watchdog watchdog_;
};

}  // namespace alphadot
