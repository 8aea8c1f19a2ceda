// Prescribed motions. Expectations: the definitions of incidence and sideslip of the relative wind, applied
// to wind and grid velocity; rates by differences of angles.
#include "motion/motion.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace alphadot {
namespace {

constexpr Real mach = 1.58, length = 0.7, reduced_frequency = 0.05, amplitude = 1.5;
constexpr Real degree = pi / 180;
constexpr Real rounding = 4e-15;  // twenty roundings of numbers of order one

Motion motion_of(MotionKind kind, Real alpha = 0, Real beta = 0) {
  MotionSettings settings;
  settings.kind = kind;
  settings.amplitude = amplitude;
  settings.reduced_frequency = reduced_frequency;
  return Motion(settings, {.mach = mach, .alpha = alpha, .beta = beta, .gamma = 1.4}, length);
}

/// Air as it meets the axis point, along body axes.
Vec3 relative_wind(const Motion& motion, Real time) {
  const Attitude now = motion.at(time);
  return on_turned_axes(motion.wind() - now.velocity, now.angle);
}

/// Moments of a cycle at which nothing is zero by chance.
Real moment(const Motion& motion, int i) {
  return (0.013 + i / 16.0) * motion.period();
}

// k = omega l / (2 V): omega from the definition, whatever the unit of length.
TEST(Motion, TurnsReducedQuantitiesIntoTimes) {
  const Motion motion = motion_of(MotionKind::plunge);
  EXPECT_NEAR(motion.omega() * length / (2 * mach), reduced_frequency, rounding);
  EXPECT_NEAR(motion.period() * motion.omega(), 2 * pi, rounding);
  EXPECT_NEAR(motion.reduced_time(motion.period()) * reduced_frequency, 2 * pi, 1e-14);
  EXPECT_NEAR(motion.time_of(motion.reduced_time(3.7)), 3.7, rounding);
}

TEST(Motion, MovesNothingWhenThereIsNone) {
  const Motion motion = motion_of(MotionKind::none, 3, 2);
  const Attitude now = motion.at(1.2);
  EXPECT_EQ(now.alpha, 3 * degree);
  EXPECT_EQ(now.beta, 2 * degree);
  EXPECT_EQ(norm(now.velocity) + norm(now.rotation) + norm(now.angle), 0);
  EXPECT_NEAR(norm(motion.wind() - wind_velocity(mach, 3 * degree, 2 * degree)), 0, rounding);
}

// Equation (4) of the paper: the field velocity turns the incidence to alpha0 + amplitude sin(k t*) and
// leaves the x velocity alone.
TEST(Plunge, TurnsTheRelativeWindByTheAmplitude) {
  for (const Real alpha : {0.0, 1.5, -4.0, 20.0})
    for (const Real beta : {0.0, 3.0}) {
      const Motion motion = motion_of(MotionKind::plunge, alpha, beta);
      for (int i = 0; i < 16; ++i) {
        const Real time = moment(motion, i);
        const Vec3 wind = relative_wind(motion, time);
        const Real expected =
            alpha * degree + amplitude * degree * std::sin(reduced_frequency * motion.reduced_time(time));
        EXPECT_NEAR(std::atan2(wind.z, wind.x), expected, rounding);
        EXPECT_NEAR(motion.at(time).alpha, expected, rounding);
        EXPECT_NEAR(wind.x, motion.wind().x, rounding);
        EXPECT_NEAR(wind.y, motion.wind().y, rounding);
      }
    }
}

// The same for sideslip: tan(beta) = lateral over longitudinal velocity in the plane of the wind's incidence.
TEST(Sway, TurnsTheRelativeWindByTheAmplitude) {
  for (const Real alpha : {0.0, 5.0})
    for (const Real beta : {0.0, 1.5, -4.0}) {
      const Motion motion = motion_of(MotionKind::sway, alpha, beta);
      for (int i = 0; i < 16; ++i) {
        const Real time = moment(motion, i);
        const Vec3 wind = relative_wind(motion, time);
        const Real expected =
            beta * degree + amplitude * degree * std::sin(reduced_frequency * motion.reduced_time(time));
        EXPECT_NEAR(std::atan2(-wind.y, std::hypot(wind.x, wind.z)), expected, rounding);
        EXPECT_NEAR(motion.at(time).beta, expected, rounding);
        EXPECT_NEAR(std::atan2(wind.z, wind.x), alpha * degree, rounding);
      }
    }
}

TEST(PlungeAndSway, DoNotRotate) {
  for (const MotionKind kind : {MotionKind::plunge, MotionKind::sway}) {
    const Motion motion = motion_of(kind, 2, 1);
    for (int i = 0; i < 16; ++i) {
      const Attitude now = motion.at(moment(motion, i));
      EXPECT_EQ(norm(now.rotation) + norm(now.angle), 0);
      EXPECT_GT(norm(now.velocity), 0);
    }
  }
}

// Pitching about the axis point: it stays, and the wind along body axes has the incidence of the attitude and
// its full speed.
TEST(Pitch, TurnsTheBodyIntoTheWind) {
  for (const Real alpha : {0.0, 2.0, 15.0}) {
    const Motion motion = motion_of(MotionKind::pitch, alpha);
    for (int i = 0; i < 16; ++i) {
      const Real time = moment(motion, i);
      const Vec3 wind = relative_wind(motion, time);
      const Real expected =
          alpha * degree + amplitude * degree * std::sin(reduced_frequency * motion.reduced_time(time));
      EXPECT_NEAR(std::atan2(wind.z, wind.x), expected, rounding);
      EXPECT_NEAR(motion.at(time).alpha, expected, rounding);
      EXPECT_NEAR(norm(wind), mach, rounding);
      EXPECT_EQ(norm(motion.at(time).velocity), 0);
    }
  }
}

// Central differences: error step^2 / 6 times the third derivative, amplitude omega^3 / 6 step^2 < 1e-11.
TEST(Pitch, RotatesAtTheRateOfItsAngle) {
  const Motion motion = motion_of(MotionKind::pitch, 2);
  constexpr Real step = 1e-4;
  for (int i = 0; i < 16; ++i) {
    const Real time = moment(motion, i);
    const Vec3 rate = (0.5 / step) * (motion.at(time + step).angle - motion.at(time - step).angle);
    for (int d = 0; d < 3; ++d) EXPECT_NEAR(motion.at(time).rotation[d], rate[d], 1e-11);
  }
  // The largest rate, at t = 0, is amplitude times omega.
  EXPECT_NEAR(motion.at(0).rotation.y, amplitude * degree * motion.omega(), rounding);
}

TEST(HarmonicMotions, RepeatAfterAPeriod) {
  for (const MotionKind kind : {MotionKind::plunge, MotionKind::sway, MotionKind::pitch}) {
    const Motion motion = motion_of(kind, 2, 1);
    for (int i = 0; i < 16; ++i) {
      const Attitude now = motion.at(moment(motion, i)),
                     then = motion.at(moment(motion, i) + motion.period());
      EXPECT_NEAR(now.alpha, then.alpha, rounding);
      EXPECT_NEAR(now.beta, then.beta, rounding);
      EXPECT_NEAR(norm(now.velocity - then.velocity), 0, rounding);
      EXPECT_NEAR(norm(now.rotation - then.rotation), 0, rounding);
    }
  }
}

// A motion starts from the steady attitude.
TEST(HarmonicMotions, StartFromRest) {
  for (const MotionKind kind : {MotionKind::plunge, MotionKind::sway, MotionKind::pitch}) {
    const Attitude start = motion_of(kind, 2, 1).at(0);
    EXPECT_EQ(start.alpha, 2 * degree);
    EXPECT_EQ(start.beta, 1 * degree);
    EXPECT_EQ(norm(start.velocity) + norm(start.angle), 0);
  }
}

// Every turn's rate is the derivative of its angle, and velocity and angle give the incidence; central
// differences err by step^2 / 6 times the third derivative.
TEST(EveryMotion, HasRatesThatAreDerivatives) {
  constexpr Real step = 1e-4;
  for (const MotionKind kind :
       {MotionKind::plunge, MotionKind::sway, MotionKind::pitch, MotionKind::yaw, MotionKind::roll,
        MotionKind::flap, MotionKind::step_alpha, MotionKind::ramp_alpha, MotionKind::step_q}) {
    MotionSettings settings;
    settings.kind = kind;
    settings.amplitude = kind == MotionKind::step_q ? 0.01 : amplitude;
    settings.reduced_frequency = reduced_frequency;
    const Motion motion(settings, {.mach = mach, .alpha = 2, .beta = 1, .gamma = 1.4}, length, 40);
    for (const Real time : {0.3, 1.7, 4.1}) {
      const Attitude now = motion.at(time);
      const Vec3 turning = (0.5 / step) * (motion.at(time + step).angle - motion.at(time - step).angle);
      for (int d = 0; d < 3; ++d) EXPECT_NEAR(now.rotation[d], turning[d], 1e-10);
      const Vec3 wind = relative_wind(motion, time);
      EXPECT_NEAR(std::atan2(wind.z, wind.x), now.alpha, rounding);
      EXPECT_NEAR(std::atan2(-wind.y, std::hypot(wind.x, wind.z)), now.beta, rounding);
    }
  }
}

// Nose to port first: beta grows by the angle (level flight). Starboard wing down first.
TEST(YawAndRoll, TurnTheWayTheyAreDocumented) {
  const Motion yaw = motion_of(MotionKind::yaw), roll = motion_of(MotionKind::roll, 10);
  const Real early = 0.1 * yaw.period();
  const Real angle = amplitude * degree * std::sin(0.2 * pi);
  EXPECT_NEAR(yaw.at(early).beta, angle, rounding);
  EXPECT_NEAR(yaw.driven_angle(yaw.at(early)), angle, rounding);
  EXPECT_NEAR(roll.at(early).angle.x, -angle, rounding);
  EXPECT_NEAR(roll.driven_angle(roll.at(early)), angle, rounding);
  // With the starboard wing down, what blows from below at incidence blows from starboard.
  EXPECT_GT(roll.at(early).beta, 0);
}

// The wind along the axes of the body stays as it is, whatever the angle.
TEST(FlapAndStepQ, HoldTheIncidence) {
  MotionSettings settings;
  settings.kind = MotionKind::step_q;
  settings.amplitude = 0.02;
  const Motion step(settings, {.mach = mach, .alpha = 3, .beta = 2, .gamma = 1.4}, length);
  const Motion flap = motion_of(MotionKind::flap, 3, 2);
  for (const Motion* motion : {&step, &flap})
    for (int i = 0; i < 16; ++i) {
      const Vec3 wind = relative_wind(*motion, 0.7 * i);
      for (int d = 0; d < 3; ++d) EXPECT_NEAR(wind[d], motion->wind()[d], rounding);
    }
  // The reduced rate, by definition q length / (2 V).
  EXPECT_NEAR(step.at(1).rotation.y * length / (2 * mach), 0.02, rounding);
  EXPECT_NEAR(norm(step.at(0).velocity), 0, rounding);
}

TEST(StepAndRamp, ReachTheirAmplitude) {
  MotionSettings settings;
  settings.kind = MotionKind::step_alpha;
  settings.amplitude = 1.5;
  const FreestreamSettings stream{.mach = mach, .alpha = 2, .beta = 0, .gamma = 1.4};
  const Motion step(settings, stream, length);
  EXPECT_EQ(step.at(-1e-9).alpha, 2 * degree);
  EXPECT_NEAR(step.at(0).alpha, 3.5 * degree, rounding);
  EXPECT_TRUE(step.starts_with_jump());
  settings.kind = MotionKind::ramp_alpha;
  const Motion ramp(settings, stream, length, 30);
  EXPECT_FALSE(ramp.starts_with_jump());
  EXPECT_NEAR(ramp.at(ramp.time_of(10)).alpha, 2.5 * degree, rounding);
  EXPECT_NEAR(ramp.at(ramp.time_of(30)).alpha, 3.5 * degree, rounding);
  EXPECT_NEAR(ramp.at(ramp.time_of(50)).alpha, 3.5 * degree, rounding);
}

}  // namespace
}  // namespace alphadot
