#include <gtest/gtest.h>

#include "analysis/coefficients.hpp"
#include "analysis/estimate.hpp"

namespace alphadot {
namespace {

TEST(Coefficients, OrderOfNamesIsOrderOfEntries) {
  const Coefficients c{.CA = 1, .CY = 2, .CN = 3, .Cl = 4, .Cm = 5, .Cn = 6};
  for (int i = 0; i < Coefficients::size(); ++i) EXPECT_EQ(c[i], i + 1);
  EXPECT_EQ(coefficient_names[2], "CN");
  EXPECT_EQ(coefficient_names[4], "Cm");
}

// Right-hand rule with x aft, y starboard, z up: a push up at the nose lifts it, a push to starboard at the
// nose turns it there, a push up on the port wing lowers the starboard one (Cl positive).
TEST(Coefficients, SignsOfMoments) {
  const auto loads = [](const Vec3& point, const Vec3& push) {
    return coefficients_of(push, cross(point, push));
  };
  const Vec3 nose{-1, 0, 0}, port{0, -1, 0};
  EXPECT_EQ(loads(nose, {0, 0, 1}).Cm, 1);
  EXPECT_EQ(loads(nose, {0, 1, 0}).Cn, 1);
  EXPECT_EQ(loads(port, {0, 0, 1}).Cl, 1);
  EXPECT_EQ(loads({0, 0, 1}, {1, 0, 0}).Cm, 1) << "drag above the centre lifts the nose: Cm = z Fx - x Fz";
}

// Expected: the moments of the same two forces taken anew about the other centre.
TEST(Coefficients, TransferEqualsMomentsTakenAnew) {
  const Vec3 points[] = {{2, -1, 0.5}, {-3, 0.25, 4}}, forces[] = {{1, 2, 3}, {-0.5, 4, -6}};
  const auto about = [&](const Vec3& centre) {
    Vec3 force, moment;
    for (int i = 0; i < 2; ++i) {
      force += forces[i];
      moment += cross(points[i] - centre, forces[i]);
    }
    return coefficients_of(force, moment);
  };
  const Vec3 old_centre{5.5, 0, 0}, new_centre{5.2, 0.3, -0.7};
  const Coefficients moved = moment_transfer(about(old_centre), new_centre - old_centre);
  for (int i = 0; i < Coefficients::size(); ++i)
    EXPECT_NEAR(moved[i], about(new_centre)[i], 1e-13) << coefficient_names[i];
}

TEST(Coefficients, TransferWidensTheUncertaintyByTheForces) {
  CoefficientsOf<Estimate> loads;
  loads.CN = {10, 0.1};
  loads.Cm = {-17, 0.5};
  const auto moved = moment_transfer(loads, Vec3{-0.3, 0, 0});
  EXPECT_NEAR(moved.Cm.value, -17 - 0.3 * 10, 1e-14);
  EXPECT_NEAR(moved.Cm.uncertainty, 0.5 + 0.3 * 0.1, 1e-14);
  EXPECT_NEAR(moved.CN.uncertainty, 0.1, 1e-14);
}

}  // namespace
}  // namespace alphadot
