// A rigid body by itself. Expectations: the exact rotation without moments, by Jacobi's elliptic functions
// and of a symmetric top; conserved quantities; a fall; the pendulum of the trapezoidal rule.
#include "motion/rigid_body.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "core/error.hpp"
#include "motion/motion.hpp"

namespace alphadot {
namespace {

constexpr std::array all{true, true, true};

/// sn, cn and dn of u with parameter m, by the arithmetic-geometric mean (Abramowitz & Stegun 16.4).
std::array<Real, 3> jacobi(Real u, Real m) {
  std::array<Real, 30> a, c;
  a[0] = 1;
  c[0] = std::sqrt(m);
  Real b = std::sqrt(1 - m);
  std::size_t n = 0;
  for (; std::abs(c[n]) > 1e-16 && n + 1 < a.size(); ++n) {
    a[n + 1] = (a[n] + b) / 2;
    c[n + 1] = (a[n] - b) / 2;
    b = std::sqrt(a[n] * b);
  }
  Real phi = std::ldexp(a[n] * u, static_cast<int>(n));
  for (; n > 0; --n) phi = (phi + std::asin(c[n] / a[n] * std::sin(phi))) / 2;
  return {std::sin(phi), std::cos(phi), std::sqrt(1 - m * std::sin(phi) * std::sin(phi))};
}

/// Of a body with moments of inertia 1, 2, 3 that begins about the first and third axes (Landau & Lifshitz,
/// Mechanics, section 37).
Vec3 tumbling(const Vec3& start, Real time) {
  const Real i1 = 1, i2 = 2, i3 = 3;
  const Real energy2 = i1 * start.x * start.x + i3 * start.z * start.z;
  const Real square = i1 * i1 * start.x * start.x + i3 * i3 * start.z * start.z;
  EXPECT_GT(square, energy2 * i2);
  const Real rate = std::sqrt((i3 - i2) * (square - energy2 * i1) / (i1 * i2 * i3));
  const Real m = (i2 - i1) * (energy2 * i3 - square) / ((i3 - i2) * (square - energy2 * i1));
  const auto [sn, cn, dn] = jacobi(rate * time, m);
  const Real second = std::sqrt((energy2 * i3 - square) / (i2 * (i3 - i2)));
  return {start.x * cn, second * sn, start.z * dn};
}

RigidBodyState flown(const RigidBody& body, RigidBodyState state, Real time, int steps) {
  for (int i = 0; i < steps; ++i) state = body.advance(state, {}, time / steps);
  return state;
}

TEST(RigidBody, TumblesAsJacobisFunctionsSay) {
  const RigidBody body({.mass = 1, .inertia = {1, 0, 0, 2, 0, 3}, .gravity = {}, .moves = all, .turns = all});
  RigidBodyState start;
  start.rotation = {0.6, 0, 0.9};
  const Vec3 momentum = body.angular_momentum(start);
  constexpr Real time = 25;
  Real before = 0;
  for (const int steps : {500, 1000, 2000}) {
    const auto end = flown(body, start, time, steps);
    const Real error = norm(end.rotation - tumbling(start.rotation, time));
    if (before > 0) {
      EXPECT_NEAR(before / error, 4, 0.1);  // of second order
    }
    before = error;
    EXPECT_NEAR(body.kinetic_energy(end) / body.kinetic_energy(start), 1, 1e-12);
    EXPECT_LT(norm(body.angular_momentum(end) - momentum), 1e-12);
  }
  EXPECT_LT(before, 1e-4);
}

// Its axis goes about the momentum L at the rate L / I1, and it turns about itself at W3 (1 - I3 / I1).
TEST(RigidBody, PrecessesAsASymmetricTop) {
  const RigidBody body(
      {.mass = 1, .inertia = {2, 0, 0, 2, 0, 0.5}, .gravity = {}, .moves = {}, .turns = all});
  RigidBodyState start;
  start.rotation = {0.3, 0, 1.1};
  const Vec3 momentum = body.angular_momentum(start);
  constexpr Real time = 20;
  const Vec3 about_itself{0, 0, start.rotation.z * (1 - 0.5 / 2) * time};
  const auto exact = quaternion_of(time / 2 * momentum) * quaternion_of(about_itself);
  Real before = 0;
  for (const int steps : {1000, 2000}) {
    const auto end = flown(body, start, time, steps).attitude;
    const Real error =
        1 - std::abs(end.w * exact.w + dot(end.v, exact.v));  // half the square of the angle's half
    if (before > 0) {
      EXPECT_NEAR(before / error, 16, 1);
    }
    before = error;
  }
  EXPECT_LT(before, 1e-8);
}

// Without the turn of the momentum onto new axes the energy is not kept: what the test above looks at is
// there.
TEST(RigidBody, HasGyroscopicMoments) {
  const RigidBody body({.mass = 1, .inertia = {1, 0, 0, 2, 0, 3}, .gravity = {}, .moves = {}, .turns = all});
  RigidBodyState start;
  start.rotation = {0.6, 0, 0.9};
  const auto next = body.advance(start, {}, 1e-3);
  EXPECT_NEAR((next.rotation.y - start.rotation.y) / 1e-3, (3.0 - 1.0) / 2 * 0.6 * 0.9, 1e-6);
}

TEST(RigidBody, FallsOnAParabola) {
  const Vec3 gravity{0.01, 0, -0.2};
  const RigidBody body({.mass = 3,
                        .inertia = {1, 0, 0, 1, 0, 1},
                        .gravity = gravity,
                        .moves = {true, false, true},
                        .turns = {}});
  RigidBodyState start;
  start.velocity = {0.1, 0, 0.4};
  const auto end = flown(body, start, 5, 7);
  EXPECT_LT(norm(end.position - (5 * start.velocity + 12.5 * gravity)), 1e-14);
  EXPECT_NEAR(end.work, body.kinetic_energy(end) - body.kinetic_energy(start), 1e-14);
}

// A spring about the y axis of a body whose other axes are held, though its inertia has products: the angle
// swings with tan(w dt / 2) = w0 dt / 2, and energy is what the spring has given.
TEST(RigidBody, SwingsAboutAHeldAxisAsAPendulum) {
  const RigidBody body({.mass = 0,
                        .inertia = {2, 0.4, 0.1, 1.5, -0.3, 2},
                        .gravity = {},
                        .moves = {},
                        .turns = {false, true, false}});
  constexpr Real stiffness = 0.6, step = 0.2, amplitude = 0.02;
  const Real exact = 2 / step * std::atan(std::sqrt(stiffness / 1.5) * step / 2);
  RigidBodyState state;
  state.attitude = quaternion_of({0, amplitude, 0});
  const auto moment = [&](const RigidBodyState& s) {
    return Vec3{0, -stiffness * rotation_vector(s.attitude).y, 0};
  };
  for (int i = 1; i <= 200; ++i) {
    auto next = state;
    for (int inner = 0; inner < 40; ++inner)
      next = body.advance(state, {{}, 0.5 * (moment(state) + moment(next))}, step);
    state = next;
    EXPECT_NEAR(rotation_vector(state.attitude).y, amplitude * std::cos(exact * i * step), 1e-12);
    EXPECT_EQ(state.rotation.x, 0);
    EXPECT_NEAR(body.kinetic_energy(state), state.work, 1e-17);
  }
}

TEST(RigidBody, RefusesWhatHasNoInertia) {
  const auto of = [](Symmetric3 inertia, Real mass, std::array<bool, 3> moves) {
    return RigidBody({.mass = mass, .inertia = inertia, .gravity = {}, .moves = moves, .turns = all});
  };
  EXPECT_THROW(of({1, 0, 0, 1, 0, 0}, 1, all), std::logic_error);
  EXPECT_THROW(of({1, 0, 0, 1, 0, 2.1}, 1, all), std::logic_error);  // more than any mass has
  EXPECT_THROW(of({1, 1.2, 0, 1, 0, 1}, 1, all), std::logic_error);
  EXPECT_THROW(of({1, 0, 0, 1, 0, 1}, 0, all), std::logic_error);
  EXPECT_NO_THROW(of({1, 0, 0, 1, 0, 2}, 0, {}));
}

TEST(RigidBody, SaysThatAStepIsTooLong) {
  const RigidBody body(
      {.mass = 1, .inertia = {1, 0, 0, 2, 0, 2.9}, .gravity = {}, .moves = {}, .turns = all});
  RigidBodyState start;
  start.rotation = {3, 2, 1};
  EXPECT_THROW(body.advance(start, {}, 40), DivergedError);
}

TEST(Quaternion, IsItsRotationVector) {
  for (const Vec3& angle : {Vec3{}, Vec3{1e-9, 0, 0}, Vec3{0.3, -0.2, 0.5}, Vec3{0, 3.1, 0}})
    EXPECT_LT(norm(rotation_vector(quaternion_of(angle)) - angle), 1e-15);
  // The product turns vectors as its factors do in turn.
  const Vec3 a{0.4, 0.1, -0.7}, b{-0.2, 0.9, 0.3}, v{1, 2, 3};
  const Vec3 both = rotation_vector(quaternion_of(a) * quaternion_of(b));
  EXPECT_LT(norm(on_turned_axes(v, both) - on_turned_axes(on_turned_axes(v, a), b)), 1e-14);
}

}  // namespace
}  // namespace alphadot
