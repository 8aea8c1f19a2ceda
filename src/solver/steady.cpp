#include "solver/steady.hpp"

#include <algorithm>
#include <cmath>

namespace alphadot {

namespace {
constexpr Real smallest_cfl = 1e-3;
constexpr Real residual_leap =
    5;  // a residual that grows by more than this in one iteration rejects the step
constexpr int iterations_per_jacobian = 3;
}  // namespace

SteadyResult march_to_steady(ImplicitIteration& iteration, const Conditions<Real>& conditions,
                             const SteadySettings& settings, int order,
                             const std::function<bool(const SteadyProgress&)>& observer) {
  Real cfl = settings.cfl_start;
  iteration.evaluate(conditions, order);
  FlowReport report = iteration.report();
  const Real first = std::max(report.density_residual, 1e-300);
  Real previous = first;
  int since_jacobian = iterations_per_jacobian;
  int count = 0;
  const auto orders = [&] { return std::log10(first / std::max(report.density_residual, 1e-300)); };

  while (count < settings.max_iterations) {
    if (++since_jacobian >= iterations_per_jacobian) {
      iteration.linearise(conditions, {.cfl = cfl});
      since_jacobian = 0;
    }
    iteration.advance();
    iteration.evaluate(conditions, order);
    report = iteration.report();
    ++count;
    if (!report.physical || report.density_residual > residual_leap * previous) {
      iteration.undo();
      cfl *= 0.1;
      since_jacobian = iterations_per_jacobian;
      if (cfl < smallest_cfl) return {RunStatus::diverged, count, report, orders()};
      iteration.evaluate(conditions, order);
      report = iteration.report();
      continue;
    }
    previous = report.density_residual;
    cfl = std::min(cfl * settings.cfl_growth, settings.cfl_max);
    const bool go_on = observer({count, cfl, orders(), report});
    if (orders() >= settings.orders) return {RunStatus::converged, count, report, orders()};
    if (!go_on) return {RunStatus::interrupted, count, report, orders()};
  }
  return {RunStatus::completed, count, report, orders()};
}

}  // namespace alphadot
