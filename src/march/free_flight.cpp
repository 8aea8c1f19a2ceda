#include "march/free_flight.hpp"

#include <utility>

namespace alphadot {

FreeFlight::FreeFlight(const RigidBody& body, const Motion& motion, const Vec3& axis_point, Real time_step,
                       const Discretization& discretization, std::unique_ptr<GustField> gust,
                       const Vec3& moment_center, bool half_model, const Load& initial)
    : FieldVelocity(motion, axis_point, time_step, discretization, std::move(gust)),
      body_(body),
      moment_center_(moment_center),
      half_model_(half_model) {
  now_.rotation = motion.steady_rotation();
  load_ = at_rest(initial);
}

Load FreeFlight::whole(const Load& load) const {
  Load out{load.force, load.moment + cross(moment_center_ - axis_point_, load.force)};
  if (half_model_) out = {{2 * out.force.x, 0, 2 * out.force.z}, {0, 2 * out.moment.y, 0}};
  return out;
}

BodyLoad FreeFlight::at_rest(const Load& load) const {
  const auto [force, moment] = whole(load);
  const Vec3 back = -rotation_vector(now_.attitude);
  return {on_turned_axes(force, back), on_turned_axes(moment, back)};
}

Attitude FreeFlight::attitude(int) const {
  Attitude out;
  out.angle = rotation_vector(now_.attitude);
  out.rotation = on_turned_axes(now_.rotation, -out.angle);
  out.velocity = now_.velocity;
  find_incidence(out, motion_.wind());
  return out;
}

Conditions<Real> FreeFlight::conditions_now() {
  return conditions_of(attitude(0), now_.position, time_);
}

Conditions<Real> FreeFlight::move_to(int step) {
  time_ = step * time_step_;
  before_ = now_;
  load_before_ = load_;
  now_ = body_.advance(before_, load_before_, time_step_);
  return conditions_now();
}

std::optional<Conditions<Real>> FreeFlight::answer(const Load& load) {
  load_ = at_rest(load);
  const BodyLoad mean{0.5 * (load_before_.force + load_.force), 0.5 * (load_before_.moment + load_.moment)};
  now_ = body_.advance(before_, mean, time_step_);
  return conditions_now();
}

Real FreeFlight::size_of(const Load& change) const {
  const auto [force, moment] = whole(change);
  return norm(body_.acceleration(force)) + norm(body_.angular_acceleration(moment));
}

std::vector<Real> FreeFlight::numbers() const {
  std::vector<Real> out{now_.attitude.w, now_.work};
  for (const Vec3& v :
       {now_.position, now_.velocity, now_.attitude.v, now_.rotation, load_.force, load_.moment})
    out.insert(out.end(), {v.x, v.y, v.z});
  return out;
}

void FreeFlight::restore(const std::vector<Real>& numbers) {
  now_.attitude.w = numbers.at(0);
  now_.work = numbers.at(1);
  std::size_t next = 2;
  for (Vec3* v :
       {&now_.position, &now_.velocity, &now_.attitude.v, &now_.rotation, &load_.force, &load_.moment})
    for (int axis = 0; axis < 3; ++axis) (*v)[axis] = numbers.at(next++);
}

}  // namespace alphadot
