// The exact Riemann solver that the flux tests lean on. Expectations: Toro 2009, tables 4.1 and 4.2, and the
// jump conditions.
#include "exact_riemann.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace alphadot {
namespace {

using testing_support::ExactRiemann;
using testing_support::GasOnLine;

constexpr Real g = 1.4;

struct Tabulated {
  GasOnLine left, right;
  Real pressure, velocity;
};

// Inputs and results are printed with five or six digits.
TEST(ExactRiemann, FindsTheStarStatesOfTorosTable) {
  const Tabulated cases[] = {
      {{1, 0, 1}, {0.125, 0, 0.1}, 0.30313, 0.92745},
      {{1, -2, 0.4}, {1, 2, 0.4}, 0.00189, 0},
      {{1, 0, 1000}, {1, 0, 0.01}, 460.894, 19.5975},
      {{1, 0, 0.01}, {1, 0, 100}, 46.0950, -6.19633},
      {{5.99924, 19.5975, 460.894}, {5.99242, -6.19633, 46.0950}, 1691.64, 8.68975},
  };
  for (const auto& c : cases) {
    const ExactRiemann riemann(c.left, c.right, g);
    EXPECT_NEAR(riemann.star_pressure(), c.pressure, 1e-5 * std::fmax(1, c.pressure));
    EXPECT_NEAR(riemann.star_velocity(), c.velocity, 1e-5 * std::fmax(1, std::fabs(c.velocity)));
  }
}

TEST(ExactRiemann, KeepsTheUndisturbedSides) {
  const GasOnLine left{1, 0, 1}, right{0.125, 0, 0.1};
  const ExactRiemann sod(left, right, g);
  EXPECT_EQ(sod.at(-10).rho, left.rho);
  EXPECT_EQ(sod.at(10).rho, right.rho);
}

// Within a fan the entropy and the invariant u + 2a/(g - 1) are those of the side, and u - a = x / t.
TEST(ExactRiemann, HoldsTheInvariantsInAFan) {
  const GasOnLine left{1, 0, 1};
  const ExactRiemann sod(left, {0.125, 0, 0.1}, g);
  const Real s = -0.5;
  const GasOnLine w = sod.at(s);
  const Real a = std::sqrt(g * w.p / w.rho);
  EXPECT_NEAR(w.p / std::pow(w.rho, g), 1, 1e-14);
  EXPECT_NEAR(w.u + 2 * a / (g - 1), 2 * std::sqrt(g) / (g - 1), 1e-14);
  EXPECT_NEAR(w.u - a, s, 1e-14);
}

// Rankine-Hugoniot: mass, momentum and energy through the right shock of Sod's problem; its speed from mass.
TEST(ExactRiemann, MeetsTheJumpConditionsAtAShock) {
  const GasOnLine right{0.125, 0, 0.1};
  const ExactRiemann sod({1, 0, 1}, right, g);
  const GasOnLine behind = sod.at(sod.star_velocity() + 1e-9);
  const Real speed = behind.rho * behind.u / (behind.rho - right.rho);
  const Real mass = right.rho * (right.u - speed);
  const auto enthalpy = [&](const GasOnLine& w) {
    return g / (g - 1) * w.p / w.rho + 0.5 * (w.u - speed) * (w.u - speed);
  };
  EXPECT_NEAR(mass * behind.u + behind.p, mass * right.u + right.p, 1e-14);
  EXPECT_NEAR(enthalpy(behind), enthalpy(right), 1e-13);
  EXPECT_EQ(sod.at(speed + 1e-9).rho, right.rho);
  EXPECT_EQ(sod.at(speed - 1e-9).rho, behind.rho);
}

TEST(ExactRiemann, RefusesAVacuum) {
  EXPECT_THROW(ExactRiemann({1, -20, 1}, {1, 20, 1}, g), std::domain_error);
}

}  // namespace
}  // namespace alphadot
