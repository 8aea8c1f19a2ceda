// March to a steady state.
#pragma once

#include <functional>

#include "core/run_status.hpp"
#include "solver/implicit_iteration.hpp"

namespace alphadot {

/// Passed to the observer after every iteration.
struct SteadyProgress {
  int iteration;
  Real cfl;
  Real orders;  ///< decades that the residual has dropped since the first iteration
  FlowReport report;
};

struct SteadyResult {
  RunStatus status;
  int iterations;
  FlowReport report;
  Real orders;
};

/// Iterates until the density residual has dropped by `settings.orders` decades, the iterations are used up
/// (status completed) or the observer returns false (interrupted). The CFL number grows while the residual
/// behaves and is cut with the step taken back when a state turns unphysical or the residual leaps; below
/// `smallest_cfl` the run is diverged.
SteadyResult march_to_steady(ImplicitIteration& iteration, const Conditions<Real>& conditions,
                             const SteadySettings& settings, int order,
                             const std::function<bool(const SteadyProgress&)>& observer);

}  // namespace alphadot
