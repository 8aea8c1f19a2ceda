#include "solver/steady.hpp"

#include <algorithm>
#include <cmath>

namespace alphadot {

namespace {
constexpr Real smallest_cfl = 1e-3;
/// A residual that grows by more than this in one iteration rejects the step.
constexpr Real residual_leap = 5;
/// Iterations between linearisations: while the flow takes shape, and once it changes little.
constexpr int early_jacobian_age = 4, late_jacobian_age = 10;
constexpr Real early_orders = 2;
}  // namespace

SteadyResult march_to_steady(ImplicitIteration& iteration, const Conditions<Real>& conditions,
                             const SteadySettings& settings, int order,
                             const std::function<bool(const SteadyProgress&)>& observer,
                             const SteadyState& from) {
  const bool resumed = from.iteration > 0;
  Real cfl = resumed ? from.cfl : settings.cfl_start;
  iteration.evaluate(conditions, order);
  FlowReport report = iteration.report();
  const Real first = resumed ? from.first_residual : std::max(report.density_residual, 1e-300);
  Real previous = resumed ? from.previous_residual : first;
  int jacobian_age = late_jacobian_age;
  int count = from.iteration;
  const auto orders = [&] { return std::log10(first / std::max(report.density_residual, 1e-300)); };
  const auto jacobian_is_due = [&] {
    return jacobian_age >= (orders() < early_orders ? early_jacobian_age : late_jacobian_age);
  };

  if (resumed && orders() >= settings.orders) return {RunStatus::converged, count, report, orders()};
  while (count < settings.max_iterations) {
    if (jacobian_is_due()) {
      iteration.linearise(conditions, {.cfl = cfl});
      jacobian_age = 0;
    }
    ++jacobian_age;
    iteration.advance();
    iteration.evaluate(conditions, order);
    report = iteration.report();
    ++count;
    if (!report.physical || report.density_residual > residual_leap * previous) {
      iteration.undo();
      cfl *= 0.1;
      jacobian_age = late_jacobian_age;
      if (cfl < smallest_cfl) return {RunStatus::diverged, count, report, orders()};
      iteration.evaluate(conditions, order);
      report = iteration.report();
      continue;
    }
    previous = report.density_residual;
    cfl = std::min(cfl * settings.cfl_growth, settings.cfl_max);
    const Real freeze_orders = iteration.discretization().space().freeze_orders;
    if (freeze_orders > 0 && orders() >= freeze_orders) iteration.freeze_limiter(true);
    const bool go_on =
        observer({count, cfl, orders(), report, {count, cfl, first, previous}, jacobian_is_due()});
    if (orders() >= settings.orders) return {RunStatus::converged, count, report, orders()};
    if (!go_on) return {RunStatus::interrupted, count, report, orders()};
  }
  return {RunStatus::completed, count, report, orders()};
}

}  // namespace alphadot
