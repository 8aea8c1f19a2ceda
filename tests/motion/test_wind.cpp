// Wind and axes. Expectations: trigonometry, and the definitions of incidence and sideslip.
#include <gtest/gtest.h>

#include <cmath>

#include "motion/motion.hpp"
#include "motion/rigid_motion.hpp"

namespace alphadot {
namespace {

constexpr Real rounding = 2e-15;  // ten roundings of numbers of order one

void expect_near(const Vec3& found, const Vec3& expected, Real tolerance) {
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(found[i], expected[i], tolerance) << "axis " << i;
}

TEST(Wind, BlowsAftUpAndFromStarboard) {
  expect_near(wind_velocity(2, 0, 0), {2, 0, 0}, rounding);
  expect_near(wind_velocity(2, pi / 2, 0), {0, 0, 2}, rounding);
  expect_near(wind_velocity(2, 0, pi / 2), {0, -2, 0}, rounding);
}

// Definitions: tan(alpha) = w / u, sin(beta) = lateral share of the speed.
TEST(Wind, HasTheGivenSpeedAndAngles) {
  for (const Real alpha : {-0.3, 0.0, 0.2})
    for (const Real beta : {-0.1, 0.0, 0.25}) {
      const Vec3 wind = wind_velocity(1.58, alpha, beta);
      EXPECT_NEAR(norm(wind), 1.58, 2 * rounding);
      EXPECT_NEAR(std::atan2(wind.z, wind.x), alpha, rounding);
      EXPECT_NEAR(std::asin(-wind.y / 1.58), beta, rounding);
    }
}

// Axes turned nose up by theta see a wind along x come from below: V (cos, 0, sin).
TEST(TurnedAxes, SeeTheWindFromBelowWhenTheNoseIsUp) {
  expect_near(on_turned_axes({1, 0, 0}, {0, 0.3, 0}), {std::cos(0.3), 0, std::sin(0.3)}, rounding);
}

// Nose to port (+z): the wind comes from starboard. Starboard wing up (+x): starboard points up, so that what
// blows up blows to starboard.
TEST(TurnedAxes, SeeTheWindFromTheSideWhenYawedOrRolled) {
  expect_near(on_turned_axes({1, 0, 0}, {0, 0, 0.3}), {std::cos(0.3), -std::sin(0.3), 0}, rounding);
  expect_near(on_turned_axes({0, 0, 1}, {0.3, 0, 0}), {0, std::sin(0.3), std::cos(0.3)}, rounding);
}

TEST(TurnedAxes, KeepLengthsAnglesAndTheAxis) {
  const Vec3 a{1, -2, 0.5}, b{0.3, 0.7, -1.1}, turn{0.4, -0.2, 0.9};
  const Vec3 ta = on_turned_axes(a, turn), tb = on_turned_axes(b, turn);
  EXPECT_NEAR(dot(ta, tb), dot(a, b), 4 * rounding);
  EXPECT_NEAR(norm(ta), norm(a), 4 * rounding);
  expect_near(cross(ta, tb), on_turned_axes(cross(a, b), turn), 8 * rounding);
  expect_near(on_turned_axes(turn, turn), turn, rounding);
}

TEST(TurnedAxes, TurnBack) {
  const Vec3 v{1, -2, 0.5}, turn{0.4, -0.2, 0.9};
  expect_near(on_turned_axes(on_turned_axes(v, turn), -turn), v, 4 * rounding);
  expect_near(on_turned_axes(v, {}), v, 0);
}

// Turning about a fixed axis, components of a fixed vector change at the rate -omega x v.
TEST(TurnedAxes, TurnFixedVectorsAtMinusTheRotation) {
  const Vec3 v{1, -2, 0.5}, axis{0.6, 0, 0.8};
  constexpr Real at = 0.7, step = 1e-4;  // central difference: error step^2 / 6
  const Vec3 difference =
      (0.5 / step) * (on_turned_axes(v, (at + step) * axis) - on_turned_axes(v, (at - step) * axis));
  expect_near(difference, -cross(axis, on_turned_axes(v, at * axis)), 1e-8);
}

// What is fixed to a turning body moves at omega x v, about whatever axis: d/dt of the vector carried along,
// by central differences of error step^2 / 6 times third derivatives below 10. Where the axis stays, omega is
// the rate to the last bit.
TEST(AngularVelocity, CarriesWhatIsFixedToTheBody) {
  const Vec3 v{1, -2, 0.5}, rate{-0.8, 0.3, 0.6};
  constexpr Real step = 1e-4;
  for (const Vec3& angle : {Vec3{0.4, -0.2, 0.9}, Vec3{2, 1, -1.5}, Vec3{3e-3, 4e-3, 0}, Vec3{}}) {
    const auto carried = [&](Real time) { return on_turned_axes(v, -(angle + time * rate)); };
    const Vec3 difference = (0.5 / step) * (carried(step) - carried(-step));
    expect_near(difference, cross(angular_velocity(angle, rate), carried(0)), 1e-7);
  }
  expect_near(angular_velocity({0, 0.7, 0}, {0, 0.3, 0}), {0, 0.3, 0}, 0);
}

// The two branches of the factors meet: 0.01 is where the series ends, its next terms are below 1e-14.
TEST(AngularVelocity, IsContinuousWhereTheSeriesEnds) {
  const Vec3 axis{0.6, 0, 0.8}, rate{-0.8, 0.3, 0.6};
  expect_near(angular_velocity((0.01 - 1e-12) * axis, rate), angular_velocity((0.01 + 1e-12) * axis, rate),
              1e-11);
}

// The velocity of a rigid body: v = v0 + omega x r; by hand.
TEST(GridMotion, IsThatOfARigidBody) {
  const GridMotion<Real> grid{{1, 2, 3}, {0, 0.5, 0}, {5, 0, 0}};
  expect_near(grid.at({5, 7, 0}), {1, 2, 3}, 0);
  expect_near(grid.at({7, 0, 0}), {1, 2, 3 - 0.5 * 2}, rounding);
  EXPECT_NEAR(grid.normal_speed({7, 0, 0}, {0.6, 0, 0.8}), 0.6 + 0.8 * 2, rounding);
}

// Nose-up rotation lifts the nose, which points to -x.
TEST(GridMotion, LiftsTheNoseWhenItPitchesUp) {
  const GridMotion<Real> grid{{}, {0, 1, 0}, {}};
  EXPECT_GT(grid.at({-1, 0, 0}).z, 0);
}

}  // namespace
}  // namespace alphadot
