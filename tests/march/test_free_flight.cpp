// A body that flies freely in the time-accurate march. Expectations: a uniform stream solves the equations
// from axes that tumble, and does not touch what tumbles in it; balances of momentum and energy by the loads
// that the steps report.
#include "march/free_flight.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "support/moving_box.hpp"

namespace alphadot {
namespace {

using namespace testing_support;

constexpr Real time_step = 0.2;
constexpr std::array all{true, true, true};

/// A box with a body of its own.
struct FlyingBox : MovingBox {
  FlyingBox(const BoxSides& sides, const Motion& motion, const RigidBody::Properties& body, bool half_model)
      : MovingBox(sides, {}, motion, TreatmentKind::field_velocity, time_step) {
    iteration.evaluate(steady_conditions(motion.wind(), box_axis_point, gamma_air), 2);
    auto treatment = std::make_unique<FreeFlight>(RigidBody(body), motion, box_axis_point, time_step,
                                                  discretization, nullptr, iteration.moment_center(),
                                                  half_model, iteration.report().total);
    flight = treatment.get();
    march = std::make_unique<DualTime>(iteration, motion, box_axis_point, time_step, Load{},
                                       std::move(treatment));
  }
  FreeFlight* flight;
};

Motion released(const Vec3& rotation) {
  MotionSettings settings;
  settings.kind = MotionKind::free;
  settings.rotation = rotation;
  return Motion(settings, {.mach = 1.58, .alpha = 2, .beta = 1, .gamma = gamma_air}, 1);
}

BoxSides box_with_floor() {
  BoxSides sides = open_box();
  sides[4] = BoundaryKind::wall;
  return sides;
}

TEST(FreeFlight, TumblesThroughAUniformStream) {
  const Motion motion = released({0.05, -0.03, 0.08});
  const RigidBody::Properties properties{
      .mass = 2, .inertia = {1, 0.1, 0, 2, 0.2, 3}, .gravity = {0.01, 0, -0.02}, .moves = all, .turns = all};
  FlyingBox box(open_box(), motion, properties, false);
  const RigidBody body(properties);
  RigidBodyState alone;
  alone.rotation = motion.steady_rotation();
  for (int i = 0; i < 12; ++i) {
    const StepReport step = box.advance(4);
    alone = body.advance(alone, {}, time_step);
    EXPECT_EQ(alone, box.flight->state());
    EXPECT_LT(box.distance_from(free_stream(on_turned_axes(motion.wind(), step.attitude.angle), gamma_air)),
              1e-12);
  }
  EXPECT_GT(norm(rotation_vector(alone.attitude)), 0.5);
}

/// Loads along axes at rest about the centre of gravity, from what a step reports about the moment centre.
BodyLoad at_rest(const Load& load, const Vec3& center, const Quaternion& attitude, bool half_model) {
  Load whole{load.force, load.moment + cross(center - box_axis_point, load.force)};
  if (half_model) {
    whole.force = {2 * whole.force.x, 0, 2 * whole.force.z};
    whole.moment = {0, 2 * whole.moment.y, 0};
  }
  const Vec3 back = -rotation_vector(attitude);
  return {on_turned_axes(whole.force, back), on_turned_axes(whole.moment, back)};
}

TEST(FreeFlight, KeepsTheBalancesOfMomentumAndEnergy) {
  for (const bool half_model : {false, true}) {
    const Motion motion = released(half_model ? Vec3{0, 0.02, 0} : Vec3{0.02, 0.02, 0.01});
    const std::array moves = half_model ? std::array{true, false, true} : all;
    const std::array turns = half_model ? std::array{false, true, false} : all;
    const Vec3 gravity{0, 0, -0.01};
    const RigidBody body(
        {.mass = 30, .inertia = {20, 0, 0, 25, 0, 30}, .gravity = gravity, .moves = moves, .turns = turns});
    FlyingBox box(
        box_with_floor(), motion,
        {.mass = 30, .inertia = {20, 0, 0, 25, 0, 30}, .gravity = gravity, .moves = moves, .turns = turns},
        half_model);
    const Vec3 center = box.iteration.moment_center();
    RigidBodyState before = box.flight->state();
    BodyLoad load_before = at_rest(box.march->before().report.total, center, before.attitude, half_model);
    for (int i = 0; i < 5; ++i) {
      // To round-off: the load that is reported is one at the attitude before the body's last answer.
      const StepReport step = box.advance();
      const RigidBodyState& now = box.flight->state();
      const BodyLoad load = at_rest(step.report.total, center, now.attitude, half_model);
      const Vec3 force = 0.5 * (load_before.force + load.force),
                 moment = 0.5 * (load_before.moment + load.moment);
      EXPECT_GT(norm(force) + norm(moment), 1e-3);
      const Vec3 gained = 30.0 * (now.velocity - before.velocity),
                 given = time_step * (force + 30.0 * gravity);
      const Vec3 spin_gained = body.angular_momentum(now) - body.angular_momentum(before),
                 spin_given = time_step * moment;
      for (int axis = 0; axis < 3; ++axis) {
        const auto number = static_cast<std::size_t>(axis);
        EXPECT_NEAR(gained[axis], moves[number] ? given[axis] : 0, 1e-11);
        EXPECT_NEAR(spin_gained[axis], turns[number] ? spin_given[axis] : 0, 1e-11);
      }
      EXPECT_NEAR(body.kinetic_energy(now) - body.kinetic_energy(before), now.work - before.work, 1e-12);
      before = now;
      load_before = load;
    }
  }
}

// What a checkpoint holds brings the body back to the bit.
TEST(FreeFlight, GoesOnFromItsNumbers) {
  const Motion motion = released({0.02, 0.02, 0.01});
  const RigidBody::Properties properties{
      .mass = 30, .inertia = {20, 0, 0, 25, 0, 30}, .gravity = {}, .moves = all, .turns = all};
  FlyingBox box(box_with_floor(), motion, properties, false);
  for (int i = 0; i < 3; ++i) box.advance(6);
  FlyingBox other(box_with_floor(), motion, properties, false);
  other.flight->restore(box.flight->numbers());
  EXPECT_EQ(other.flight->state(), box.flight->state());
  EXPECT_EQ(other.flight->numbers(), box.flight->numbers());
  box.flight->move_to(4);
  other.flight->move_to(4);
  EXPECT_EQ(other.flight->state(), box.flight->state());
}

}  // namespace
}  // namespace alphadot
