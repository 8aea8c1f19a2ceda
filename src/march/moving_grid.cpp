#include "march/moving_grid.hpp"

#include <utility>

#include "march/deformation.hpp"

namespace alphadot {

MovingGrid::MovingGrid(const Motion& motion, const Vec3& axis_point, Real time_step, Subdomain& domain,
                       Discretization& discretization)
    : Treatment(motion, axis_point, time_step),
      weights_step_(fitted_step(time_step, motion.is_harmonic() ? motion.omega() : 0)),
      domain_(domain),
      discretization_(discretization),
      rest_(domain.points),
      now_{axis_point, {}, {}} {}

BodyPlace MovingGrid::place(int step) {
  if (step <= 0) return {axis_point_, {}, {}};
  while (static_cast<int>(travel_.size()) <= step) {
    const auto level = static_cast<int>(travel_.size());
    const TimeWeights weight = time_weights(level, weights_step_);
    const Vec3 older = level > 1 ? *(travel_.end() - 2) : Vec3{};
    travel_.push_back(
        1 / weight.now *
        (motion_.at(level * time_step_).velocity - weight.old * travel_.back() - weight.older * older));
  }
  return {axis_point_, travel_[static_cast<std::size_t>(step)], motion_.at(step * time_step_).angle};
}

void MovingGrid::renew_geometry() {
  domain_.update_metrics();
  discretization_.update_geometry();
}

Load MovingGrid::on_body(const Load& load, const Vec3& center) const {
  const Vec3 moment = load.moment - cross(now_.carried(center) - center, load.force);
  return {on_turned_axes(load.force, now_.angle), on_turned_axes(moment, now_.angle)};
}

Conditions<Real> RigidGrid::move_to(int step) {
  now_ = place(step);
  for (std::size_t point = 0; point < rest_.size(); ++point)
    domain_.points[point] = now_.carried(rest_[point]);
  renew_geometry();
  const Attitude attitude = motion_.at(step * time_step_);
  return {.free_stream = free_stream(motion_.wind(), discretization_.gamma()),
          .grid = {attitude.velocity, attitude.rotation, axis_point_ + now_.travel},
          .turning_stream = {},
          .turning_source = false};
}

std::unique_ptr<Treatment> make_treatment(TreatmentKind kind, const Motion& motion, const Vec3& axis_point,
                                          Real time_step, Subdomain& domain, Discretization& discretization,
                                          const Communicator& comm, std::unique_ptr<GustField> gust) {
  switch (kind) {
    case TreatmentKind::rigid_grid:
      return std::make_unique<RigidGrid>(motion, axis_point, time_step, domain, discretization);
    case TreatmentKind::deforming_grid:
      return std::make_unique<DeformingGrid>(motion, axis_point, time_step, domain, discretization, comm);
    case TreatmentKind::field_velocity:
      break;
  }
  return std::make_unique<FieldVelocity>(motion, axis_point, time_step, discretization, std::move(gust));
}

}  // namespace alphadot
