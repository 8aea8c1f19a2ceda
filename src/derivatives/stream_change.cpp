#include "derivatives/stream_change.hpp"

#include "motion/motion.hpp"

namespace alphadot {

namespace {

/// Truncation step^2, and round-off 1e-16 / step.
constexpr Real relative_step = 1e-5;

/// Residual of a flow under the conditions of a case, and its loads.
std::vector<Load> evaluate(ImplicitIteration& iteration, const FlightCondition& settings,
                           std::vector<Conserved<Real>>& residual) {
  const auto& about = iteration.discretization();
  const auto& comm = iteration.communicator();
  MotionSettings steady = settings.motion;
  steady.kind = MotionKind::none;
  const Motion motion(steady, settings.freestream, settings.reference.length);
  Discretization discretization(about.domain(), about.patch_kinds(), about.space(),
                                settings.freestream.gamma);
  discretization.set_dissipative(about.dissipative_cells());
  Residual at(discretization, comm);
  at.evaluate(iteration.flow(),
              steady_conditions(motion.wind(), settings.motion.axis_point, settings.freestream.gamma,
                                motion.steady_rotation()),
              about.space().order, residual);
  auto numbers = numbers_of(wall_loads(discretization, at, iteration.moment_center()));
  comm.sum(numbers);
  return loads_of(numbers);
}

}  // namespace

StreamChange::StreamChange(ImplicitIteration& iteration, const FlightCondition& settings,
                           const StreamNumber& number)
    : name_(number.name),
      step_(relative_step * settings.freestream.*number.at),
      below_{settings, {}},
      above_{settings, {}},
      residual_(static_cast<std::size_t>(iteration.discretization().domain().owned_cells)) {
  below_.settings.freestream.*number.at -= step_;
  above_.settings.freestream.*number.at += step_;
  auto residual_below = residual_;
  below_.loads = evaluate(iteration, below_.settings, residual_below);
  above_.loads = evaluate(iteration, above_.settings, residual_);
  for (std::size_t cell = 0; cell < residual_.size(); ++cell)
    residual_[cell] = (0.5 / step_) * (residual_[cell] - residual_below[cell]);
}

Real StreamChange::by_itself(const Functional& functional,
                             const std::vector<std::string>& patch_names) const {
  const auto coefficient = [&](const Side& side) {
    const auto weights = weights_of(functional, patch_names, side.settings);
    Real sum = 0;
    for (std::size_t patch = 0; patch < weights.size(); ++patch)
      sum += dot(weights[patch].force, side.loads[patch].force) +
             dot(weights[patch].moment, side.loads[patch].moment);
    return sum;
  };
  return (coefficient(above_) - coefficient(below_)) / (2 * step_);
}

}  // namespace alphadot
