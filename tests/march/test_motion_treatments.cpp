// Motions by field velocity and by moving grids. Expectations: a uniform stream solves the equations under
// every motion of the grid; a field velocity and a rigidly moving grid are the same discrete equations along
// other axes; geometry of swept volumes.
#include <gtest/gtest.h>

#include <cmath>
#include <tuple>

#include "march/deformation.hpp"
#include "partition/geometry.hpp"
#include "space/influence.hpp"
#include "support/moving_box.hpp"

namespace alphadot {
namespace {

using namespace testing_support;

constexpr MotionKind all_motions[] = {MotionKind::plunge,     MotionKind::sway,       MotionKind::pitch,
                                      MotionKind::yaw,        MotionKind::roll,       MotionKind::flap,
                                      MotionKind::step_alpha, MotionKind::ramp_alpha, MotionKind::step_q};

/// Open all around; the face x_max counts as the body that a deforming grid follows, though nothing is
/// imposed there but the stream.
BoxSides open_box_with_body() {
  BoxSides sides = open_box();
  sides[1] = BoundaryKind::jet;
  return sides;
}

/// A wall to take loads on, below or to port.
BoxSides box_with_wall(int side = 4) {
  BoxSides sides = open_box();
  sides[static_cast<std::size_t>(side)] = BoundaryKind::wall;
  return sides;
}

class EveryMotion : public testing::TestWithParam<std::tuple<MotionKind, TreatmentKind>> {};
INSTANTIATE_TEST_SUITE_P(Treatments, EveryMotion,
                         testing::Combine(testing::ValuesIn(all_motions), testing::ValuesIn(all_treatments)));

TEST_P(EveryMotion, KeepsTheFreeStream) {
  const auto [kind, treatment] = GetParam();
  const Motion motion = box_motion(kind, kind == MotionKind::step_q ? 0.03 : 3);
  MovingBox box(open_box_with_body(), {}, motion, treatment, 0.15);
  box.start();
  for (int i = 0; i < 5; ++i) {
    const StepReport step = box.advance(4);
    const Vec3 wind = treatment == TreatmentKind::field_velocity
                          ? on_turned_axes(motion.wind(), step.attitude.angle)
                          : motion.wind();
    EXPECT_LT(box.distance_from(free_stream(wind, gamma_air)), 1e-12);
  }
}

/// Largest relative difference of the loads, over some steps from a wavy flow, between a field velocity and
/// another treatment. The face x_min counts as body, so that all of the box is downstream of it.
Real difference_of_treatments(MotionKind kind, LimiterKind limiter,
                              TreatmentKind treatment = TreatmentKind::rigid_grid) {
  const Motion motion = box_motion(kind);
  // The march converges the moment that the motion drives: there must be one.
  auto sides = box_with_wall(motion.moment_axis() == 2 ? 2 : 4);
  sides[0] = BoundaryKind::jet;
  MovingBox still(sides, {.limiter = limiter}, motion, TreatmentKind::field_velocity, 0.05);
  MovingBox moving(sides, {.limiter = limiter}, motion, treatment, 0.05);
  Real worst = 0;
  for (MovingBox* box : {&still, &moving}) {
    fill(box->iteration.flow(), box->domain, [](const Vec3& x, GlobalIndex) { return wavy_state(x); });
    box->start();
  }
  for (int i = 0; i < 5; ++i) {
    const Load a = still.advance(80).report.total, b = moving.advance(80).report.total;
    worst = std::max(worst, relative_difference(a, b));
  }
  return worst;
}

TEST(FieldVelocity, IsARigidGridInTranslation) {
  EXPECT_LT(difference_of_treatments(MotionKind::plunge, LimiterKind::venkatakrishnan), 1e-10);
  EXPECT_LT(difference_of_treatments(MotionKind::sway, LimiterKind::venkatakrishnan), 1e-10);
  EXPECT_LT(difference_of_treatments(MotionKind::step_alpha, LimiterKind::venkatakrishnan), 1e-10);
}

// Where the body disturbs everything the grid moves as a whole, and the difference of its places that the
// time scheme takes is the velocity itself.
TEST(FieldVelocity, IsADeformingGridInTranslation) {
  for (const auto kind : {MotionKind::plunge, MotionKind::sway, MotionKind::step_alpha})
    EXPECT_LT(difference_of_treatments(kind, LimiterKind::venkatakrishnan, TreatmentKind::deforming_grid),
              1e-10);
}

// A limiter of velocity components depends on the axes they are taken along; without one nothing does.
TEST(FieldVelocity, IsARigidGridInRotation) {
  EXPECT_LT(difference_of_treatments(MotionKind::pitch, LimiterKind::none), 1e-8);
  EXPECT_LT(difference_of_treatments(MotionKind::yaw, LimiterKind::none), 1e-8);
  EXPECT_LT(difference_of_treatments(MotionKind::roll, LimiterKind::none), 1e-8);
  EXPECT_LT(difference_of_treatments(MotionKind::flap, LimiterKind::none), 1e-8);
}

/// Residual of a flow with a uniform velocity taken off.
std::vector<Conserved<Real>> residual_less(const BoxCase& box, const Vec3& shift,
                                           const Conditions<Real>& conditions) {
  FlowField<Real> flow(box.domain, box.comm);
  fill(flow, box.domain, [&](const Vec3& x, GlobalIndex id) {
    Primitive<Real> w = rough_state(x, id);
    for (int i = 0; i < 3; ++i) w[i + 1] -= shift[i];
    return w;
  });
  std::vector<Conserved<Real>> out(box.cells());
  Residual(box.discretization, box.comm).evaluate(flow, conditions, 2, out);
  return out;
}

// A body in a wind W and a body that moves with -W through still air, rotating steadily at fixed incidence:
// mass as it is, momentum less W mass, energy less W momentum plus W^2/2 mass, in every cell.
TEST(GalileanShift, LeavesARotatingBodyAsItIs) {
  const Communicator comm;
  const BoxCase box(small_box(), box_with_wall(), {}, comm);
  const Vec3 wind{1.5, -0.1, 0.2}, rotation{0.2, 0.5, -0.3}, axis{0.4, -0.6, 0.2};
  const auto in_wind = residual_less(box, {}, steady_conditions(wind, axis, gamma_air, rotation));
  const auto in_still_air =
      residual_less(box, wind, {free_stream(Vec3{}, gamma_air), {-wind, rotation, axis}, {}});
  for (std::size_t cell = 0; cell < in_wind.size(); ++cell) {
    const auto& a = in_wind[cell];
    const Vec3 momentum{a[1], a[2], a[3]};
    const Vec3 shifted = momentum - a[0] * wind;
    const auto& b = in_still_air[cell];
    EXPECT_NEAR(b[0], a[0], 1e-12);
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(b[i + 1], shifted[i], 1e-12);
    EXPECT_NEAR(b[4], a[4] - dot(wind, momentum) + 0.5 * dot(wind, wind) * a[0], 1e-12);
  }
}

TEST(SweptVolume, IsTheChangeOfTheVolumeOfATetrahedron) {
  const std::array<Vec3, 4> from{{{0, 0, 0}, {1, 0.1, 0}, {0.2, 1, 0.1}, {0.1, 0.3, 0.9}}};
  const std::array<Vec3, 4> to{{{0.1, -0.2, 0.3}, {1.2, 0.4, 0.1}, {-0.2, 1.3, 0.2}, {0.4, 0.2, 1.4}}};
  const std::array<GlobalIndex, 4> ids{0, 1, 2, 3};
  Real sum = 0;
  for (const auto& face : tetrahedron_faces) {
    const auto corners = [&](const std::array<Vec3, 4>& x) {
      return std::array<Vec3, 3>{x[static_cast<std::size_t>(face[0])], x[static_cast<std::size_t>(face[1])],
                                 x[static_cast<std::size_t>(face[2])]};
    };
    sum += swept_volume(corners(from), corners(to));
  }
  EXPECT_NEAR(sum, tetrahedron_metrics(to, ids).volume - tetrahedron_metrics(from, ids).volume, 1e-15);
}

// A disc across the wind, of Mach 2 and 0.5: the tangent of the cone's half-angle is 1.25 / sqrt(3), and it
// touches the corners of the face x_max, sqrt(0.61) from its centre (1, 0.6, 2.5).
TEST(Influence, IsAConeAlongTheWindOrABall) {
  const Communicator comm;
  const BoxCase box(small_box(), open_box_with_body(), {}, comm);
  const Real radius = std::sqrt(0.61), tangent = 1.25 / std::sqrt(3.0), sine = std::sin(std::atan(tangent));
  const Influence cone(box.discretization, {2, 0, 0}, comm), ball(box.discretization, {0.5, 0, 0}, comm);
  EXPECT_NEAR(cone.body_size(), 2 * radius, 1e-12);
  EXPECT_NEAR(cone.distance({-2, 0.6, 2.5}), 3 - radius / tangent, 1e-12);
  EXPECT_NEAR(cone.distance({1, 0.6, 2.5 + radius + 0.1 / std::sqrt(1 - sine * sine)}), 0.1, 1e-12);
  EXPECT_EQ(cone.distance({9, 0.6, 2.5 + radius + 7.9 * tangent}), 0);
  EXPECT_NEAR(ball.distance({-2, 0.6, 2.5}), 3 - radius, 1e-12);
  EXPECT_EQ(ball.distance({1, 0.6, 2.6}), 0);
}

// The body's points go with it, the farthest nearly stay, for the box is a little shorter than the body is
// wide, and cells keep their orientation.
TEST(DeformingGrid, FollowsTheBodyAndLagsFarAway) {
  const Motion motion = box_motion(MotionKind::pitch);
  MovingBox box(open_box_with_body(), {}, motion, TreatmentKind::deforming_grid, 0.15);
  const auto rest = box.domain.points;
  const auto share = follow_shares(box.discretization, motion.wind(), box.comm);
  EXPECT_LT(box.comm.min(std::ranges::min(share)), 0.1);
  box.start();
  const StepReport step = box.advance(1);
  for (std::size_t point = 0; point < rest.size(); ++point) {
    const Vec3 carried = box_axis_point + on_turned_axes(rest[point] - box_axis_point, -step.attitude.angle);
    const Vec3 expected = rest[point] + share[point] * (carried - rest[point]);
    EXPECT_NEAR(norm(box.domain.points[point] - expected), 0, 1e-14);
    if (rest[point].x == 1) {
      EXPECT_EQ(share[point], 1);
    }
  }
  EXPECT_NO_THROW(box.domain.validate());
}

// Everything is a function of the level: a march in two parts is the same as in one.
TEST(Treatments, GoOnAfterARestart) {
  const Motion motion = box_motion(MotionKind::pitch);
  for (const TreatmentKind treatment : all_treatments) {
    MovingBox whole(box_with_wall(), {}, motion, treatment, 0.15),
        again(box_with_wall(), {}, motion, treatment, 0.15);
    whole.start();
    for (int i = 0; i < 3; ++i) whole.advance(6);
    again.start();
    std::ranges::copy(whole.march->latest_level(), again.march->latest_level().begin());
    std::ranges::copy(whole.march->level_before(), again.march->level_before().begin());
    std::ranges::copy(whole.iteration.flow().values(), again.iteration.flow().values().begin());
    again.march->restore(whole.march->state());
    for (int i = 0; i < 2; ++i) {
      const Load a = whole.advance(6).report.total, b = again.advance(6).report.total;
      EXPECT_EQ(relative_difference(a, b), 0);
    }
  }
}

}  // namespace
}  // namespace alphadot
