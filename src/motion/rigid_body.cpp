#include "motion/rigid_body.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "core/error.hpp"
#include "motion/motion.hpp"

namespace alphadot {

namespace {

constexpr int most_iterations = 100;

/// What of a vector lies along free axes.
Vec3 along(const std::array<bool, 3>& free, Vec3 v) {
  for (int axis = 0; axis < 3; ++axis)
    if (!free[static_cast<std::size_t>(axis)]) v[axis] = 0;
  return v;
}

/// The tensor with unit inertia, and none in common, about held axes.
Symmetric3 free_part(Symmetric3 a, const std::array<bool, 3>& free) {
  if (!free[0]) a.xx = 1;
  if (!free[1]) a.yy = 1;
  if (!free[2]) a.zz = 1;
  if (!free[0] || !free[1]) a.xy = 0;
  if (!free[0] || !free[2]) a.xz = 0;
  if (!free[1] || !free[2]) a.yz = 0;
  return a;
}

}  // namespace

RigidBody::RigidBody(const Properties& properties)
    : properties_(properties), inverse_(inverse(free_part(properties.inertia, properties.turns))) {
  const bool has_mass = properties.mass > 0 || properties.moves == std::array<bool, 3>{};
  if (!has_mass || !has_inertia(properties)) throw std::logic_error("a rigid body without inertia");
}

RigidBodyState RigidBody::advance(const RigidBodyState& from, const BodyLoad& mean, Real time_step) const {
  const auto& [mass, inertia, gravity, moves, turns] = properties_;
  RigidBodyState out;
  const Vec3 change = time_step * (acceleration(along(moves, mean.force)) + along(moves, gravity));
  out.velocity = from.velocity + change;
  const Vec3 travel = time_step / 2 * (from.velocity + out.velocity);
  out.position = from.position + travel;

  const Vec3 angle = rotation_vector(from.attitude);
  const Vec3 momentum = inertia * from.rotation + time_step * on_turned_axes(mean.moment, angle);
  out.rotation = from.rotation;
  Vec3 turn;
  Real last = 0;
  for (int iteration = 0;; ++iteration) {
    turn = time_step / 2 * (from.rotation + out.rotation);
    const Vec3 next = angular_acceleration(on_turned_axes(momentum, turn));
    const Real correction = norm(next - out.rotation);
    out.rotation = next;
    // To round-off, where corrections no longer shrink.
    const bool is_small = correction <= 1e-12 * norm(next);
    if (correction == 0 || (is_small && iteration > 0 && correction >= last)) break;
    if (!std::isfinite(correction) || iteration == most_iterations)
      throw DivergedError("the body turns too far in one time step: take more unsteady.steps");
    last = correction;
  }
  turn = time_step / 2 * (from.rotation + out.rotation);
  out.attitude = normalised(from.attitude * quaternion_of(turn));
  out.work =
      from.work + dot(mean.force + mass * gravity, travel) + dot(mean.moment, on_turned_axes(turn, -angle));
  return out;
}

Real RigidBody::kinetic_energy(const RigidBodyState& state) const {
  return 0.5 * (properties_.mass * dot(state.velocity, state.velocity) +
                dot(state.rotation, properties_.inertia * state.rotation));
}

Vec3 RigidBody::angular_momentum(const RigidBodyState& state) const {
  return on_turned_axes(properties_.inertia * state.rotation, -rotation_vector(state.attitude));
}

Vec3 RigidBody::acceleration(const Vec3& force) const {
  return along(properties_.moves, properties_.mass > 0 ? 1 / properties_.mass * force : Vec3{});
}

Vec3 RigidBody::angular_acceleration(const Vec3& moment) const {
  return along(properties_.turns, inverse_ * along(properties_.turns, moment));
}

bool has_inertia(const RigidBody::Properties& properties) {
  const auto [xx, xy, xz, yy, yz, zz] = free_part(properties.inertia, properties.turns);
  const Real minor = xx * yy - xy * xy;
  const Real all = zz * minor - xx * yz * yz + 2 * xy * xz * yz - yy * xz * xz;
  const bool is_definite = xx > 0 && minor > 0 && all > 0;
  if (properties.turns != std::array{true, true, true}) return is_definite;
  constexpr Real round_off = 1 + 1e-9;
  return is_definite && xx <= round_off * (yy + zz) && yy <= round_off * (xx + zz) &&
         zz <= round_off * (xx + yy);
}

RigidBody::Properties properties_of(const BodySettings& body, Real length, Real speed) {
  const Real cube = length * length * length, fifth = cube * length * length;
  RigidBody::Properties out;
  out.mass = cube * body.mass;
  const auto& [ix, iy, iz] = body.inertia;
  const auto& [pxy, pxz, pyz] = body.products;
  out.inertia = {fifth * ix, -fifth * pxy, -fifth * pxz, fifth * iy, -fifth * pyz, fifth * iz};
  out.gravity = speed * speed / length * body.gravity;
  for (const FreedomKind freedom : body.free) {
    const auto number = static_cast<std::size_t>(freedom);
    (number < 3 ? out.moves : out.turns)[number % 3] = true;
  }
  return out;
}

}  // namespace alphadot
