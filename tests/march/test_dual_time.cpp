// The time-accurate march. Expectations: a uniform stream solves the equations exactly, also seen from axes
// that turn; backward differences are of second order from the first step on; piston theory.
#include "march/dual_time.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "support/moving_box.hpp"

namespace alphadot {
namespace {

using namespace testing_support;

BoxSides box_with_floor() {
  BoxSides sides = open_box();
  sides[4] = BoundaryKind::wall;
  return sides;
}

// The old levels are turned onto the axes of the new one: components that turn are no change at all.
TEST(DualTime, FollowsAUniformStreamExactlyFromTurningAxes) {
  for (const MotionKind kind : {MotionKind::plunge, MotionKind::pitch}) {
    const Motion motion = box_motion(kind, 5);
    MovingBox box(open_box(), {}, motion, TreatmentKind::field_velocity, motion.period() / 16);
    box.start();
    for (int i = 1; i <= 16; ++i) {
      const StepReport step = box.advance(4);
      EXPECT_EQ(step.step, i);
      EXPECT_NEAR(step.time, i * motion.period() / 16, 1e-12);
      EXPECT_EQ(step.attitude.alpha, motion.at(step.time).alpha);
      const auto exact =
          field_velocity_conditions(step.attitude, motion.wind(), box_axis_point, gamma_air).free_stream;
      EXPECT_LT(box.distance_from(exact), 1e-12);
    }
  }
}

/// A motion from level flight along the floor.
Motion level_motion(MotionKind kind, Real amplitude) {
  MotionSettings settings;
  settings.kind = kind;
  settings.amplitude = amplitude;
  settings.reduced_frequency = 0.3;
  return Motion(settings, {.mach = 1.58, .alpha = 0, .beta = 0, .gamma = gamma_air}, 1);
}

/// Force on the floor at `time` after the start.
Real force_at(MotionKind kind, Real time, int steps) {
  const Motion motion = level_motion(kind, 1);
  MovingBox box(box_with_floor(), {.order = 1}, motion, TreatmentKind::field_velocity, time / steps);
  box.start();
  StepReport report;
  for (int i = 0; i < steps; ++i) report = box.advance(12);
  return report.report.total.force.z;
}

// Motions set in at t = 0 with a jump of the rate or of the acceleration. Backward differences that take the
// state before as given lag by half a step ever after, an error of first order: successive differences would
// halve. Second order: a quarter, of which a fifth is allowed for higher terms.
TEST(DualTime, IsOfSecondOrderFromTheStart) {
  for (const MotionKind kind : {MotionKind::plunge, MotionKind::pitch}) {
    const Real time = 0.3 * level_motion(kind, 1).period();
    const Real coarse = force_at(kind, time, 24), medium = force_at(kind, time, 48),
               fine = force_at(kind, time, 96);
    EXPECT_GT((coarse - medium) / (medium - fine), 3.2);
  }
}

// A wall that starts with a small speed v into gas at rest on it: dp = rho a v, all over the wall.
TEST(DualTime, StartsAStepWithPistonTheory) {
  const Motion motion = level_motion(MotionKind::step_alpha, 0.01);
  MovingBox box(box_with_floor(), {}, motion, TreatmentKind::field_velocity, 0.1);
  box.start();
  box.iteration.evaluate(steady_conditions(motion.wind(), box_axis_point, gamma_air), 2);
  EXPECT_NEAR(box.march->before().report.total.force.z, 0, 1e-13);
  const StepReport start = box.march->just_after_start();
  EXPECT_EQ(start.time, 0);
  // The floor is below the gas and sinks: suction, which pulls it up.
  constexpr Real area = 2 * 1.2;
  const Real sinking = 1.58 * std::tan(0.01 * radians_per_degree);
  EXPECT_NEAR(start.report.total.force.z, sinking * area, 2 * sinking * sinking * area);
}

}  // namespace
}  // namespace alphadot
