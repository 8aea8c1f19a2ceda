// Fluxes at walls and the far field. Expectations: the characteristic theory of the Euler equations.
#include <gtest/gtest.h>

#include "euler/boundary.hpp"
#include "exact_riemann.hpp"
#include "samples.hpp"

namespace alphadot {
namespace {

using namespace testing_support;

constexpr Real g = gamma_air;

Real invariant(const Primitive<Real>& w, const Vec3& normal, Real sign) {
  return dot(velocity(w), normal) + sign * 2 / (g - 1) * sound_speed(w, g);
}
Real entropy(const Primitive<Real>& w) {
  return w[4] / std::pow(w[0], g);
}
Vec3 tangential(const Primitive<Real>& w, const Vec3& normal) {
  return velocity(w) - dot(velocity(w), normal) * normal;
}

// A wall lets nothing through: the physical flux of a gas that moves with it.
TEST(Wall, IsThePhysicalFluxOfAGasThatMovesWithIt) {
  Samples samples(61);
  for (int i = 0; i < 100; ++i) {
    const Vec3 normal = samples.direction();
    const Real speed = samples.between(-2, 2);
    auto w = samples.state();
    w = with_velocity(w, tangential(w, normal) + speed * normal);
    expect_near(wall_flux(w[4], normal, speed), physical_flux(w, normal, speed, g),
                1e-13 * (1 + largest(conserved(w, g))));
  }
}

// By symmetry a wall is the middle of the Riemann problem between the gas and its mirror image.
TEST(Wall, FeelsTheStarPressureOfTheGasAndItsMirrorImage) {
  Samples samples(62);
  for (int i = 0; i < 200; ++i) {
    const Vec3 normal = samples.direction();
    const Real speed = samples.between(-2, 2);
    const auto w = samples.state();
    const Real into = dot(velocity(w), normal) - speed;
    if (into < -0.9 * 2 / (g - 1) * sound_speed(w, g)) continue;  // nearly a vacuum
    const ExactRiemann exact({w[0], into, w[4]}, {w[0], -into, w[4]}, g);
    EXPECT_NEAR(wall_pressure(w, normal, speed, g) / exact.star_pressure(), 1, 1e-10);
  }
}

TEST(Wall, FeelsNothingOnceTheGasCannotFollow) {
  EXPECT_EQ(wall_pressure<Real>({{1, 0, 0, -5.1, 1 / g}}, {0, 0, 1}, 0, g), 0);
}

TEST(Wall, DoesTheWorkOfItsPressure) {
  expect_near(wall_flux(2.0, {0, 0.6, 0.8}, 0.5), {{0, 0, 1.2, 1.6, 1.0}}, 1e-15);
}

// From standstill to Mach 5, flow in and out, through a face that moves or not.
TEST(FarField, LeavesAUniformStreamAlone) {
  Samples samples(62);
  for (const Real mach : {0.0, 0.3, 0.8, 0.99, 1.0, 1.01, 1.58, 2.5, 5.0})
    for (int i = 0; i < 100; ++i) {
      const auto stream = free_stream(mach * samples.direction(), g);
      const Vec3 normal = samples.direction();
      for (const Real speed : {0.0, samples.between(-3, 3)}) {
        expect_near(characteristic_state(stream, stream, normal, speed, g), stream, 1e-13 * (1 + mach));
        expect_near(far_field_flux(stream, stream, normal, speed, g), physical_flux(stream, normal, speed, g),
                    1e-12 * (1 + mach * mach));
      }
    }
}

// Straight out of, into and along the face, at exactly sonic relative speed too.
TEST(FarField, LeavesAUniformStreamAloneAtSonicSpeeds) {
  const Vec3 normal{0, 0, 1};
  for (const Real relative : {-2.0, -1.0, -0.5, 0.0, 0.5, 1.0, 2.0})
    for (const Real speed : {0.0, 0.7, -1.3}) {
      const auto stream = free_stream(Vec3{0.3, -0.2, relative + speed}, g);
      expect_near(characteristic_state(stream, stream, normal, speed, g), stream, 1e-13);
    }
}

/// Two states that differ by a tenth, crossing the face at about `mach` relative to it.
struct FarFieldPair {
  FarFieldPair(Samples& samples, Real mach) : normal(samples.direction()), speed(samples.between(-2, 2)) {
    const Vec3 base = samples.vector(1);
    const auto near = [&](Real m) {
      auto w = samples.state(1.1, 0.05);
      return with_velocity(w, velocity(w) + base + (speed + m - dot(base, normal)) * normal);
    };
    inside = near(mach);
    outside = near(mach);
  }
  Vec3 normal;
  Real speed;
  Primitive<Real> inside, outside;
};

TEST(FarField, TakesSupersonicInflowFromOutside) {
  Samples samples(63);
  for (int i = 0; i < 100; ++i) {
    const FarFieldPair pair(samples, -1.5);
    expect_near(characteristic_state(pair.inside, pair.outside, pair.normal, pair.speed, g), pair.outside, 0);
  }
}

TEST(FarField, TakesSupersonicOutflowFromInside) {
  Samples samples(64);
  for (int i = 0; i < 100; ++i) {
    const FarFieldPair pair(samples, 1.5);
    expect_near(characteristic_state(pair.inside, pair.outside, pair.normal, pair.speed, g), pair.inside, 0);
  }
}

// Subsonic: the invariant u + 2a/(g-1) leaves, u - 2a/(g-1) enters; entropy and tangential velocity come with
// the flow.
TEST(FarField, KeepsTheInvariantsOfSubsonicFlow) {
  Samples samples(65);
  for (const Real mach : {-0.6, 0.6})
    for (int i = 0; i < 100; ++i) {
      const FarFieldPair pair(samples, mach);
      const auto face = characteristic_state(pair.inside, pair.outside, pair.normal, pair.speed, g);
      const auto& upstream = mach > 0 ? pair.inside : pair.outside;
      EXPECT_NEAR(invariant(face, pair.normal, 1), invariant(pair.inside, pair.normal, 1), 1e-12);
      EXPECT_NEAR(invariant(face, pair.normal, -1), invariant(pair.outside, pair.normal, -1), 1e-12);
      EXPECT_NEAR(entropy(face), entropy(upstream), 1e-12);
      EXPECT_NEAR(norm(tangential(face, pair.normal) - tangential(upstream, pair.normal)), 0, 1e-13);
    }
}

// Shifting both states and the face by one velocity shifts the state on the face by it.
TEST(FarField, IsTheSameInEveryInertialFrame) {
  Samples samples(66);
  for (int i = 0; i < 300; ++i) {
    const FarFieldPair pair(samples, samples.between(-1.5, 1.5));
    const Vec3 s = samples.vector(3);
    const auto shifted = [&](const Primitive<Real>& w) { return with_velocity(w, velocity(w) + s); };
    expect_near(characteristic_state(shifted(pair.inside), shifted(pair.outside), pair.normal,
                                     pair.speed + dot(s, pair.normal), g),
                shifted(characteristic_state(pair.inside, pair.outside, pair.normal, pair.speed, g)), 1e-12);
  }
}

// A weak acoustic wave that runs straight out leaves no reflection: a simple wave keeps the entering
// invariant and the entropy, so that the state inside is the state on the face. Exact.
TEST(FarField, LetsSimpleWavesOut) {
  Samples samples(67);
  for (int i = 0; i < 100; ++i) {
    const Vec3 normal = samples.direction();
    const Real outflow = samples.between(-0.5, 0.5), a = samples.between(0.9, 1.1);
    const auto outside = with_velocity(free_stream(Vec3{}, g), outflow * normal);
    Primitive<Real> inside = with_velocity(outside, (outflow + 2 / (g - 1) * (a - 1)) * normal);
    inside[0] = std::pow(a, 2 / (g - 1));
    inside[4] = inside[0] * a * a / g;
    expect_near(characteristic_state(inside, outside, normal, 0.0, g), inside, 1e-13);
  }
}

}  // namespace
}  // namespace alphadot
