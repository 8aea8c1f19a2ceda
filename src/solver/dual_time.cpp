#include "solver/dual_time.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "core/error.hpp"

namespace alphadot {

namespace {
constexpr Real pseudo_cfl = 1e6;     // the physical time term is damping enough
constexpr Real slowest_rate = 0.95;  // of convergence of the moment that its error estimate allows for
}  // namespace

DualTime::DualTime(ImplicitIteration& iteration, const Motion& motion, const Vec3& axis_point, Real time_step,
                   const Load& initial)
    : iteration_(iteration),
      motion_(motion),
      axis_point_(axis_point),
      time_step_(time_step),
      initial_(initial),
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

Real DualTime::moment_scale(const StepReport& step, Real amplitude) {
  const int axis = motion_.moment_axis();
  state_.largest_angle = std::max(state_.largest_angle, std::abs(motion_.driven_angle(step.attitude)));
  state_.largest_moment =
      std::max(state_.largest_moment, std::abs(step.report.total.moment[axis] - initial_.moment[axis]));
  return state_.largest_angle > 0 ? state_.largest_moment * amplitude / state_.largest_angle
                                  : state_.largest_moment;
}

void DualTime::keep_levels() {
  const Real gamma = iteration_.discretization().gamma();
  std::swap(older_, old_);
  for (std::size_t i = 0; i < old_.size(); ++i)
    old_[i] = conserved(iteration_.flow()[static_cast<Index>(i)], gamma);
}

StepReport DualTime::advance(const InnerTolerance& tolerance) {
  StepReport out;
  out.step = ++state_.step;
  out.time = time();
  out.attitude = motion_.at(out.time);
  const auto conditions = field_velocity_conditions(out.attitude, motion_.wind(), axis_point_,
                                                    iteration_.discretization().gamma());
  const int axis = motion_.moment_axis();
  predict();
  iteration_.linearise(conditions, {.cfl = pseudo_cfl, .inverse_step = 1.5 / time_step_});
  Real first = 0, change = 0;
  Load previous;
  for (int inner = 0;; ++inner) {
    iteration_.evaluate(conditions, iteration_.discretization().space().order);
    add_time_derivative();
    out.report = iteration_.report();
    if (!out.report.physical)
      throw DivergedError("the flow became unphysical in time step " + std::to_string(state_.step));
    if (inner == 0) first = std::max(out.report.density_residual, 1e-300);
    out.inner_iterations = inner;
    out.inner_orders = std::log10(first / std::max(out.report.density_residual, 1e-300));

    // Changes that shrink by the rate r each time leave r / (1 - r) times the latest one.
    const Load delta = out.report.total - previous;
    const Real previous_change = change;
    change = std::abs(delta.moment[axis]);
    const Real rate = std::clamp(change / std::max(previous_change, 1e-300), slowest_rate / 2, slowest_rate);
    out.error = rate / (1 - rate) * delta;
    previous = out.report.total;
    const Real allowed = tolerance.share * moment_scale(out, tolerance.amplitude);
    if (inner >= 3 && std::abs(out.error.moment[axis]) <= allowed) break;
    if (inner >= tolerance.max_iterations) break;
    iteration_.advance();
  }
  keep_levels();
  return out;
}

}  // namespace alphadot
