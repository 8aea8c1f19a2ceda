// March to a steady state.
#pragma once

#include <functional>

#include "core/run_status.hpp"
#include "march/implicit_iteration.hpp"

namespace alphadot {

/// What a march needs, besides the flow, to go on exactly as if it had not stopped.
struct SteadyState {
  int iteration = 0;
  Real cfl = 0;
  Real first_residual = 0, previous_residual = 0;
  Real lowest_residual = 0;  ///< so far; steps of a few per cent are passed over
  int lowest_at = 0;         ///< the iteration that reached it
};

/// Passed to the observer after every iteration.
struct SteadyProgress {
  int iteration;
  Real cfl;
  Real orders;  ///< decades that the residual has dropped since the first iteration
  FlowReport report;
  SteadyState state;
  /// The next iteration linearises anew, so that `state` and the flow are all that it depends on.
  bool resumable;
};

struct SteadyResult {
  RunStatus status;
  int iterations;
  FlowReport report;
  Real orders;
};

/// Iterates until the density residual has dropped by `settings.orders` decades, the iterations are used up
/// (status completed) or the observer returns false (interrupted). The CFL number grows while the residual
/// behaves; when a state turns unphysical or the residual leaps, the step is taken back, the CFL number cut
/// and some iterations of first order let the flow settle; after too many such steps the run is diverged. A
/// residual of nothing but round-off counts as converged too. The limiter is frozen after so many decades as
/// its settings say, or where the residual has stopped to fall: at strong shocks it may never come to rest.
/// Starts from the flow in `iteration`, or goes on `from` the state that belongs to it.
///
/// There is no start of first order: on the Basic Finner's coarse mesh at Mach 2.5 six decades take 34, 34,
/// 38, 43 and 48 iterations and 3.1, 2.8, 3.3, 3.5 and 3.7 s of one core after 0, 5, 10, 15 and 20 iterations
/// of first order.
SteadyResult march_to_steady(ImplicitIteration& iteration, const Conditions<Real>& conditions,
                             const SteadySettings& settings, int order,
                             const std::function<bool(const SteadyProgress&)>& observer,
                             const SteadyState& from = {});

}  // namespace alphadot
