#include "solver/dual_time.hpp"

#include <algorithm>
#include <cmath>

#include "core/error.hpp"

namespace alphadot {

namespace {
constexpr Real pseudo_cfl = 1e6;               // the physical time term is damping enough
constexpr int iterations_per_jacobian = 1000;  // one linearisation a step
}  // namespace

DualTime::DualTime(ImplicitIteration& iteration, const Motion& motion, const Vec3& axis_point, Real time_step)
    : iteration_(iteration),
      motion_(motion),
      axis_point_(axis_point),
      time_step_(time_step),
      old_(static_cast<std::size_t>(iteration.discretization().domain().owned_cells)) {
  const Real gamma = iteration.discretization().gamma();
  for (std::size_t cell = 0; cell < old_.size(); ++cell)
    old_[cell] = conserved(iteration.flow()[static_cast<Index>(cell)], gamma);
  older_ = old_;
}

void DualTime::predict() {
  const Real gamma = iteration_.discretization().gamma();
  for (std::size_t i = 0; i < old_.size(); ++i) {
    const auto guess = primitive(Real{2} * old_[i] - older_[i], gamma);
    auto& w = iteration_.flow()[static_cast<Index>(i)];
    if (guess[0] > 0.5 * w[0] && guess[4] > 0.5 * w[4]) w = guess;
  }
}

void DualTime::add_time_derivative() {
  const Subdomain& domain = iteration_.discretization().domain();
  const Real gamma = iteration_.discretization().gamma();
  auto values = iteration_.residual_values();
  for (Index cell = 0; cell < domain.owned_cells; ++cell) {
    const Real scale = domain.volume[cell] / (2 * time_step_);
    const auto now = conserved(iteration_.flow()[cell], gamma);
    values[cell] += scale * (Real{3} * now - Real{4} * old_[cell] + older_[cell]);
  }
}

StepReport DualTime::advance(const InnerTolerance& tolerance) {
  ++step_;
  StepReport out{.step = step_,
                 .time = time(),
                 .attitude = motion_.at(time()),
                 .inner_iterations = 0,
                 .inner_orders = 0,
                 .moment_error = 0,
                 .report = {}};
  const auto conditions = field_velocity_conditions(out.attitude, motion_.wind(), axis_point_,
                                                    iteration_.discretization().gamma());
  predict();
  Real first = 0, change = 0, moment = 0;
  for (int inner = 0;; ++inner) {
    iteration_.evaluate(conditions, iteration_.discretization().space().order);
    add_time_derivative();
    out.report = iteration_.report();
    if (!out.report.physical)
      throw DivergedError("the flow became unphysical in time step " + std::to_string(step_));
    if (inner == 0) first = std::max(out.report.density_residual, 1e-300);
    const Real previous_change = change;
    change = std::abs(out.report.total.moment.y - moment);
    moment = out.report.total.moment.y;
    // Changes that shrink by the rate r leave r / (1 - r) times the latest one.
    const Real rate =
        inner < 2 ? Real{0.99} : std::clamp(change / std::max(previous_change, 1e-300), 0.5, 0.99);
    out.moment_error = inner == 0 ? 1 : change * rate / (1 - rate);
    out.inner_iterations = inner;
    out.inner_orders = std::log10(first / std::max(out.report.density_residual, 1e-300));
    if ((inner >= 3 && out.moment_error < tolerance.moment) || inner >= tolerance.max_iterations) break;
    if (inner % iterations_per_jacobian == 0)
      iteration_.linearise(conditions, {.cfl = pseudo_cfl, .inverse_step = 1.5 / time_step_});
    iteration_.advance();
  }
  for (std::size_t i = 0; i < old_.size(); ++i) {
    older_[i] = old_[i];
    old_[i] = conserved(iteration_.flow()[static_cast<Index>(i)], iteration_.discretization().gamma());
  }
  return out;
}

}  // namespace alphadot
