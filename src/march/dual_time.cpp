#include "march/dual_time.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "core/error.hpp"

namespace alphadot {

namespace {
constexpr Real pseudo_cfl = 1e6;  // the physical time term is damping enough
constexpr int stall = 10;         // inner iterations that end a step when they do not lower the residual ...
constexpr Real least_drop = 0.8;  // ... to this share of the lowest so far
constexpr Real slowest_rate = 0.95;  // of convergence of the moment that its error estimate allows for

/// The same state along axes turned by `angle`.
Conserved<Real> turned(const Conserved<Real>& u, const Vec3& angle) {
  const Vec3 momentum = on_turned_axes({u[1], u[2], u[3]}, angle);
  return {{u[0], momentum.x, momentum.y, momentum.z, u[4]}};
}
}  // namespace

DualTime::DualTime(ImplicitIteration& iteration, const Motion& motion, const Vec3& axis_point, Real time_step,
                   const Load& initial, std::unique_ptr<Treatment> treatment)
    : iteration_(iteration),
      motion_(motion),
      treatment_(std::move(treatment)),
      axis_point_(axis_point),
      time_step_(time_step),
      weights_step_(fitted_step(time_step, motion.is_harmonic() ? motion.omega() : 0)),
      initial_(initial),
      old_(static_cast<std::size_t>(iteration.discretization().domain().owned_cells)) {
  if (!treatment_)
    treatment_ = std::make_unique<FieldVelocity>(motion, axis_point, time_step, iteration.discretization());
  keep_levels({});
  older_ = old_;
}

void DualTime::predict(const Vec3& axes) {
  const Real gamma = iteration_.discretization().gamma();
  for (std::size_t i = 0; i < old_.size(); ++i) {
    const auto guess = primitive(turned(Real{2} * old_[i] - older_[i], axes), gamma);
    auto& w = iteration_.flow()[static_cast<Index>(i)];
    if (guess[0] > 0.5 * w[0] && guess[4] > 0.5 * w[4]) w = guess;
  }
}

void DualTime::add_time_derivative(const Vec3& axes) {
  const Subdomain& domain = iteration_.discretization().domain();
  const Real gamma = iteration_.discretization().gamma();
  const TimeWeights weight = time_weights(state_.step, weights_step_);
  const auto volume = treatment_->volumes(0), old_volume = treatment_->volumes(1),
             older_volume = treatment_->volumes(2);
  auto values = iteration_.residual_values();
  for (Index cell = 0; cell < domain.owned_cells; ++cell) {
    const auto now = conserved(iteration_.flow()[cell], gamma);
    values[cell] +=
        weight.now * volume[cell] * now +
        turned(weight.old * old_volume[cell] * old_[cell] + weight.older * older_volume[cell] * older_[cell],
               axes);
  }
}

FlowReport DualTime::report() const {
  FlowReport out = iteration_.report();
  for (Load& load : out.loads) load = treatment_->on_body(load, iteration_.moment_center());
  out.total = treatment_->on_body(out.total, iteration_.moment_center());
  return out;
}

Real DualTime::moment_scale(const StepReport& step, Real amplitude) {
  state_.largest_angle = std::max(state_.largest_angle, std::abs(motion_.driven_angle(step.attitude)));
  state_.largest_moment = std::max(state_.largest_moment, treatment_->size_of(step.report.total - initial_));
  return amplitude > 0 && state_.largest_angle > 0 ? state_.largest_moment * amplitude / state_.largest_angle
                                                   : state_.largest_moment;
}

void DualTime::keep_levels(const Vec3& axes) {
  const Real gamma = iteration_.discretization().gamma();
  std::swap(older_, old_);
  old_.resize(older_.size());
  for (std::size_t i = 0; i < old_.size(); ++i)
    old_[i] = turned(conserved(iteration_.flow()[static_cast<Index>(i)], gamma), -axes);
}

StepReport DualTime::before() const {
  StepReport out;
  out.attitude = treatment_->attitude(0);
  out.report = report();
  return out;
}

StepReport DualTime::just_after_start() const {
  StepReport out = before();
  out.attitude = motion_.at(0);
  iteration_.evaluate(field_velocity_conditions(out.attitude, motion_.wind(), axis_point_,
                                                iteration_.discretization().gamma()),
                      iteration_.discretization().space().order);
  out.report = report();
  return out;
}

StepReport DualTime::advance(const InnerTolerance& tolerance) {
  StepReport out;
  out.step = ++state_.step;
  out.time = time();
  auto conditions = treatment_->move_to(state_.step);
  out.attitude = treatment_->attitude(state_.step);
  Vec3 axes = treatment_->axes(out.attitude);
  const Real inverse_step = time_weights(state_.step, weights_step_).now;
  predict(axes);
  iteration_.linearise(conditions, {.cfl = pseudo_cfl, .inverse_step = inverse_step});
  Real first = 0, change = 0, lowest = 0;
  int lowest_at = 0;
  Load previous;
  for (int inner = 0;; ++inner) {
    iteration_.evaluate(conditions, iteration_.discretization().space().order);
    add_time_derivative(axes);
    out.report = report();
    if (!out.report.physical)
      throw DivergedError("the flow became unphysical in time step " + std::to_string(state_.step));
    if (inner == 0) first = std::max(out.report.density_residual, 1e-300);
    if (inner == 0 || out.report.density_residual < least_drop * lowest) {
      lowest = out.report.density_residual;
      lowest_at = inner;
    }
    out.inner_iterations = inner;
    out.inner_orders = std::log10(first / std::max(out.report.density_residual, 1e-300));

    // Changes that shrink by the rate r each time leave r / (1 - r) times the latest one.
    const Load delta = out.report.total - previous;
    const Real previous_change = change;
    change = treatment_->size_of(delta);
    const Real shrinking = inner < 2 ? slowest_rate : change / std::max(previous_change, 1e-300);
    const Real rate = std::clamp(shrinking, slowest_rate / 2, slowest_rate);
    out.error = rate / (1 - rate) * delta;
    previous = out.report.total;
    const Real allowed = tolerance.share * moment_scale(out, tolerance.amplitude);
    const Real left = treatment_->size_of(out.error);
    out.inner_left = left / std::max(allowed, 1e-300);
    const auto answered = treatment_->answer(out.report.total);
    out.attitude = treatment_->attitude(state_.step);
    if (inner >= 3 && left <= allowed) break;
    if (inner >= tolerance.max_iterations || inner - lowest_at >= stall) break;
    iteration_.advance();
    if (!answered) continue;
    conditions = *answered;
    axes = treatment_->axes(out.attitude);
  }
  keep_levels(axes);
  return out;
}

}  // namespace alphadot
