// What every numerical flux owes to the equations: consistency, conservation, invariance under rotation,
// change of frame and scale, and upwinding. All exact; tolerances are round-off of the largest entry.
#include <gtest/gtest.h>

#include "euler/kinds.hpp"
#include "samples.hpp"

namespace alphadot {
namespace {

using namespace testing_support;

constexpr Real round_off = 1e-13;  // some 500 roundings: differences of energies of both sides
constexpr int draws = 300;

class FluxSymmetry : public testing::TestWithParam<FluxKind> {
 protected:
  /// Two states far apart, a direction and the speed of the face.
  struct Draw {
    Primitive<Real> left, right;
    Vec3 normal;
    Real speed;
  };

  Draw draw() { return {samples.state(), samples.state(), samples.direction(), samples.between(-2, 2)}; }
  Conserved<Real> flux(const Draw& d) const {
    return numerical_flux(model, d.left, d.right, d.normal, d.speed);
  }
  /// Largest entry of the physical fluxes of both sides.
  static Real scale(const Draw& d) {
    return 1 + largest(physical_flux(d.left, d.normal, d.speed, gamma_air),
                       physical_flux(d.right, d.normal, d.speed, gamma_air));
  }

  const FluxModel model{GetParam(), gamma_air, 0.1};
  Samples samples{21};
};
INSTANTIATE_TEST_SUITE_P(Fluxes, FluxSymmetry, testing::ValuesIn(all_fluxes),
                         [](const auto& kind) { return name_of(kind.param); });

TEST_P(FluxSymmetry, IsConsistent) {
  for (int i = 0; i < draws; ++i) {
    Draw d = draw();
    d.right = d.left;
    expect_near(flux(d), physical_flux(d.left, d.normal, d.speed, gamma_air), round_off * scale(d));
  }
}

TEST_P(FluxSymmetry, GivesOneSideWhatItTakesFromTheOther) {
  for (int i = 0; i < draws; ++i) {
    const Draw d = draw();
    expect_near(flux({d.right, d.left, -d.normal, -d.speed}), -1.0 * flux(d), round_off * scale(d));
  }
}

TEST_P(FluxSymmetry, TurnsWithTheAxes) {
  for (int i = 0; i < draws; ++i) {
    const Draw d = draw();
    const Vec3 axis = samples.direction();
    const Real angle = samples.between(-pi, pi);
    const auto turned_state = [&](const Primitive<Real>& w) {
      return with_velocity(w, turned(velocity(w), axis, angle));
    };
    const auto expected = turned_state(flux(d));  // entries 1 to 3 of a flux are a vector too
    expect_near(flux({turned_state(d.left), turned_state(d.right), turned(d.normal, axis, angle), d.speed}),
                expected, round_off * scale(d));
  }
}

// In a frame in which all moves faster by s: mass as before; momentum + s mass; energy + s.momentum + s^2/2
// mass.
TEST_P(FluxSymmetry, IsTheSameInEveryInertialFrame) {
  for (int i = 0; i < draws; ++i) {
    const Draw d = draw();
    const Vec3 s = samples.vector(3);
    const Draw shifted{with_velocity(d.left, velocity(d.left) + s),
                       with_velocity(d.right, velocity(d.right) + s), d.normal, d.speed + dot(s, d.normal)};
    const auto rest = flux(d);
    auto expected = with_velocity(rest, momentum(rest) + rest[0] * s);
    expected[4] += dot(s, momentum(rest)) + 0.5 * dot(s, s) * rest[0];
    expect_near(flux(shifted), expected, round_off * (scale(d) + scale(shifted)));
  }
}

// The equations are homogeneous: density and pressure times k give k times the flux.
TEST_P(FluxSymmetry, ScalesWithDensityAndPressure) {
  const auto scaled = [](Primitive<Real> w, Real k) {
    w[0] *= k;
    w[4] *= k;
    return w;
  };
  for (int i = 0; i < draws; ++i) {
    const Draw d = draw();
    const Real k = samples.between(0.1, 10);
    expect_near(flux({scaled(d.left, k), scaled(d.right, k), d.normal, d.speed}), k * flux(d),
                round_off * k * scale(d));
  }
}

// All waves run away from one side when the flow crosses the face at four times the speed of sound or more:
// sound speeds lie between 0.8 and 1.25 here, and those of Roe's mean cannot exceed 1.4.
TEST_P(FluxSymmetry, TakesSupersonicFlowFromUpstream) {
  for (int i = 0; i < draws; ++i) {
    Draw d = draw();
    const auto supersonic = [&] {
      Primitive<Real> w = samples.state(10, 1);
      const Real a = samples.between(0.8, 1.25);
      w[4] = w[0] * a * a / gamma_air;
      const Vec3 along = (d.speed + samples.between(5, 6) - dot(velocity(w), d.normal)) * d.normal;
      return with_velocity(w, velocity(w) + along);
    };
    d.left = supersonic();
    d.right = supersonic();
    expect_near(flux(d), physical_flux(d.left, d.normal, d.speed, gamma_air), round_off * scale(d));
    const Draw mirrored{d.right, d.left, -d.normal, -d.speed};
    expect_near(flux(mirrored), physical_flux(d.left, -d.normal, -d.speed, gamma_air), round_off * scale(d));
  }
}

}  // namespace
}  // namespace alphadot
