// March to a steady state.
#pragma once

#include <functional>
#include <limits>

#include "core/run_status.hpp"
#include "march/implicit_iteration.hpp"
#include "march/settings.hpp"

namespace alphadot {

inline constexpr Real unlimited = std::numeric_limits<Real>::infinity();

/// Whether a march takes Newton-Krylov steps, or has given them up again.
enum class KrylovSteps { not_yet, taken, given_up };

/// What a march needs, besides the flow, to go on exactly as if it had not stopped.
struct SteadyState {
  int iteration = 0;
  Real cfl = 0;
  Real first_residual = 0, previous_residual = 0;
  Real lowest_residual = 0;  ///< so far; smaller steps than a half are passed over
  int lowest_at = 0;         ///< the iteration that reached it
  Real begun_residual = 0;   ///< where the latest iterations of second order began
  int begun_at = 0;          ///< and the iteration
  int rejections = 0;        ///< steps taken back so far
  Load least, most;          ///< total load since then, component by component
  KrylovSteps krylov = KrylovSteps::not_yet;
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
  /// Decades that the residual has dropped when the limiter is free, as it is in a motion: the same, unless
  /// the limiter is frozen.
  Real free_orders;
  /// The march ended before its last iteration because nothing more was to be had.
  bool has_stalled;
  Load swing;  ///< largest less smallest total load since the residual was last seen to fall
};

/// Iterates until the density residual has dropped by `settings.orders` decades, the iterations are used up
/// or the residual has not fallen for as many iterations as led there and 150 more (both status completed),
/// or the observer returns false (interrupted). The CFL number grows while the residual
/// behaves; when a state turns unphysical or the residual leaps, the step is taken back, the CFL number cut
/// and iterations of first order let the flow settle, until their residual has fallen to a hundredth or for
/// twenty of them; after too many such steps the run is diverged. A
/// residual of nothing but round-off counts as converged too. The limiter is frozen after so many decades as
/// its settings say, or where the residual has stopped to fall: at some shocks it never comes to rest.
///
/// Where the scheme alone is slow, or bold steps were taken back twice, and the settings say so,
/// Newton-Krylov steps follow: exact derivatives of the second-order residual, a CFL number that grows as the
/// residual falls (switched evolution relaxation, Mulder & van Leer 1985), steps that raise the residual
/// halved. A step costs as much as 10 to 20 iterations of the scheme, so that flows which the scheme brings
/// to rest by a decade in 20 iterations, counted from the latest ones of first order, see none. Steps that
/// get nowhere are given up for the scheme alone.
///
/// Where `early_cfl_max` is not unlimited, as for a flow that bold steps have driven into vacuum, the CFL
/// number stays below it until the residual has dropped by a decade, and then rises with the residual's fall;
/// Newton-Krylov steps wait for that decade too.
///
/// Starts from the flow in `iteration`, or goes on `from` the state that belongs to it.
///
/// There is no start of first order: on the Basic Finner's coarse mesh at Mach 2.5 six decades take 34, 34,
/// 38, 43 and 48 iterations and 3.1, 2.8, 3.3, 3.5 and 3.7 s of one core after 0, 5, 10, 15 and 20 iterations
/// of first order.
SteadyResult march_to_steady(ImplicitIteration& iteration, const Conditions<Real>& conditions,
                             const SteadySettings& settings, int order,
                             const std::function<bool(const SteadyProgress&)>& observer,
                             const SteadyState& from = {}, Real early_cfl_max = unlimited);

}  // namespace alphadot
