// Harten's entropy fix in Roe's solver.
#include <gtest/gtest.h>

#include "core/dual.hpp"
#include "samples.hpp"

namespace alphadot {
namespace {

using namespace testing_support;

// Harten 1983: psi = |z| beyond delta, (z^2 / delta + delta) / 2 below.
TEST(Harten, IsTheModulusBeyondDelta) {
  for (const Real z : {-3.0, -0.5, 0.5, 2.0}) EXPECT_EQ(harten(z, 0.5), std::abs(z));
  for (const Real z : {-1.0, 0.0, 1e-300, 2.0}) EXPECT_EQ(harten(z, 0.0), std::abs(z)) << "no fix";
}

TEST(Harten, IsBoundedBelowByTheModulusAndHalfOfDelta) {
  constexpr Real delta = 0.3;
  for (int i = -100; i <= 100; ++i) {
    const Real z = 0.005 * i;
    EXPECT_GE(harten(z, delta), std::abs(z));
    EXPECT_GE(harten(z, delta), 0.5 * delta);
    EXPECT_LE(harten(z, delta), std::max(std::abs(z), delta));
    EXPECT_EQ(harten(z, delta), harten(-z, delta));
  }
  EXPECT_EQ(harten(0.0, delta), 0.5 * delta);
}

// Value and slope meet |z| at delta: differences shrink like (delta - z)^2 / (2 delta) and (delta - z) /
// delta.
TEST(Harten, JoinsTheModulusSmoothly) {
  constexpr Real delta = 0.5, gap = 1e-6;
  Dual<1> z = delta - gap;
  z.d[0] = 1;
  const auto psi = harten(z, Dual<1>(delta));
  EXPECT_NEAR(psi.v, z.v, 1.01 * gap * gap / (2 * delta));
  EXPECT_NEAR(psi.d[0], 1 - gap / delta, 1e-12);
}

// On a contact that moves with the face, Roe's mean sound speed is a^2 = g p / rho_mean here (both sides at
// rest relative to it), H = a^2 / (g - 1) is the mean of the sides' H weighted by root rho, and the fix lets
// mass through at the speed delta / 2 = share * a / 2, of which the flux takes half: -share a (rho_R - rho_L)
// / 4.
TEST(EntropyFix, LeaksMassInProportionToItsShare) {
  const Primitive<Real> left{{1, 0, 0, 0, 1}}, right{{4, 0, 0, 0, 1}};
  const Real g = gamma_air;
  // sqrt(rho) = 1 and 2; a^2 = g p / rho of each side.
  const Real a = std::sqrt((1 * g * 1 / 1 + 2 * g * 1 / 4) / 3);
  for (const Real share : {0.0, 0.05, 0.1, 0.3}) {
    const auto flux = roe_flux(left, right, {0, 0, 1}, 0.0, g, share);
    EXPECT_NEAR(flux[0], -share * a * 3 / 4, 1e-14);
    EXPECT_NEAR(flux[3], 1, 1e-14) << "pressure is not touched: the contact carries no normal momentum";
  }
}

// A shock turned round would be an expansion against the second law. Roe's solver takes it for a solution
// (all fluxes are equal); the fix gives its sonic wave dissipation and so breaks it up.
TEST(EntropyFix, BreaksUpExpansionShocks) {
  const Real g = gamma_air, mach = 1.5, m2 = mach * mach;
  const Real density = (g + 1) * m2 / ((g - 1) * m2 + 2), pressure = (2 * g * m2 - (g - 1)) / (g + 1);
  const Primitive<Real> slow{{density, mach / density, 0, 0, pressure / g}}, fast{{1, mach, 0, 0, 1 / g}};
  const Vec3 normal{1, 0, 0};
  const auto held = physical_flux(slow, normal, 0.0, g);
  expect_near(roe_flux(slow, fast, normal, 0.0, g, 0.0), held, 1e-13 * largest(held));
  // The sonic wave carries the whole jump of density, drho = density - 1; the mass flux gains half of delta /
  // 2 = share (u + a) / 2 = share * u times it, u = a being Roe's mean, which lies between the two speeds.
  for (const Real share : {0.05, 0.1}) {
    const Real gain = roe_flux(slow, fast, normal, 0.0, g, share)[0] - held[0];
    EXPECT_GT(gain, 0.5 * share * (mach / density) * (density - 1));
    EXPECT_LT(gain, 0.5 * share * mach * (density - 1));
  }
}

}  // namespace
}  // namespace alphadot
