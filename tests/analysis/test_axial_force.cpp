// Estimates of friction and of the base beside values from elsewhere.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "analysis/axial_force.hpp"

namespace alphadot {
namespace {

/// K. E. Schoenherr's mean coefficients at no Mach number (1932), 0.242 / sqrt(c) = log10(Re c), as
/// tabulated.
TEST(Friction, IsSchoenherrsAtLowSpeed) {
  for (const auto& [reynolds, expected] :
       std::vector<std::pair<Real, Real>>{{1e6, 0.00441}, {1e7, 0.00293}, {1e8, 0.00207}, {1e9, 0.00153}})
    EXPECT_NEAR(plate_friction(1e-6, reynolds, 0), expected, 6e-6);
}

TEST(Friction, IsBlasiusWhereLaminar) {
  EXPECT_NEAR(plate_friction(1e-6, 1e6, 2e6), 1.328e-3, 1e-9);
  // E. R. van Driest, NACA TN 2597 (1952): laminar friction at an adiabatic wall falls by 5 % at Mach 2 and
  // by 15 % at Mach 4, read from his figure.
  EXPECT_NEAR(plate_friction(2, 1e6, 2e6) / 1.328e-3, 0.95, 0.01);
  EXPECT_NEAR(plate_friction(4, 1e6, 2e6) / 1.328e-3, 0.86, 0.02);
}

/// An independent correlation: Prandtl's and Schlichting's at Eckert's reference temperature.
TEST(Friction, IsNearTheReferenceTemperatureMethod) {
  for (const Real mach : {0.5, 1.0, 2.0, 3.0})
    for (const Real reynolds : {1e6, 1e7, 1e8}) {
      const Real hotter = 0.2 * std::cbrt(0.71) * mach * mach, reference = 1 + 0.72 * hotter;
      const Real expected =
          0.455 * std::pow(std::log10(reynolds * std::pow(reference, -1.76)), -2.58) / reference;
      EXPECT_NEAR(plate_friction(mach, reynolds, 0) / expected, 1, 0.11) << mach << " " << reynolds;
    }
}

TEST(Friction, OfAPlateWithTransition) {
  const Real all = plate_friction(1.5, 5e6, 0), half = plate_friction(1.5, 5e6, 2.5e6),
             none = plate_friction(1.5, 5e6, 5e6);
  EXPECT_LT(none, half);
  EXPECT_LT(half, all);
  EXPECT_NEAR(plate_friction(1.5, 5e6, 5e6 - 1), none, 1e-8);  // continuous
  // Twice the area has twice the force; a plate as long as two reference lengths has twice their number.
  const std::vector<Plate> plates{{1, 2}, {3, 2}};
  EXPECT_NEAR(friction_force(plates, 1.5, {.reynolds = 2.5e6}), 4 * all, 1e-15);
}

/// E. L. Fleeman's power-off base drag, 0.12 + 0.13 M^2 and 0.25 / M, and no pressure below zero.
TEST(Base, IsFleemans) {
  EXPECT_DOUBLE_EQ(base_pressure(0.5, 1.4), -0.1525);
  EXPECT_DOUBLE_EQ(base_pressure(2, 1.4), -0.125);
  EXPECT_NEAR(base_pressure(1 - 1e-9, 1.4), base_pressure(1, 1.4), 1e-8);
  EXPECT_DOUBLE_EQ(base_pressure(10, 1.4), -2 / 140.0);
}

}  // namespace
}  // namespace alphadot
