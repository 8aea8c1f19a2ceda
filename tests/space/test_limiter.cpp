// Slope limiters. Expectations: the formulas of their papers in y = bound / delta.
#include "space/limiter.hpp"

#include <gtest/gtest.h>

namespace alphadot {
namespace {

// Barth & Jespersen 1989: min(1, y).
TEST(BarthJespersen, CutsToTheRoomThereIs) {
  for (const Real sign : {-1.0, 1.0}) {
    EXPECT_EQ(barth_jespersen(sign * 0.5, sign * 2.0), 1);
    EXPECT_EQ(barth_jespersen(sign * 2.0, sign * 2.0), 1);
    EXPECT_EQ(barth_jespersen(sign * 4.0, sign * 1.0), 0.25);
    EXPECT_EQ(barth_jespersen(sign * 4.0, 0.0), 0);
  }
  EXPECT_EQ(barth_jespersen(0.0, 0.0), 1) << "a flat field is not limited";
}

// Venkatakrishnan 1995 without epsilon: (y^2 + 2y) / (y^2 + y + 2).
TEST(Venkatakrishnan, IsThePapersFunction) {
  for (const Real sign : {-1.0, 1.0})
    for (const Real y : {0.0, 0.1, 0.5, 1.0, 1.5, 2.0, 5.0}) {
      const Real delta = sign * 0.3;
      EXPECT_NEAR(venkatakrishnan(delta, y * delta, 0), (y * y + 2 * y) / (y * y + y + 2), 1e-15);
    }
}

// With y in [0, 1] the limited change phi delta stays within the bound: phi <= y holds since (y + 2) / (y^2 +
// y + 2) <= 1.
TEST(Venkatakrishnan, StaysWithinTheRoomWithoutEpsilon) {
  for (int i = 0; i <= 100; ++i) {
    const Real y = 0.01 * i;
    EXPECT_LE(venkatakrishnan(1.0, y, 0), y + 1e-15);
  }
}

// Changes much below epsilon pass whole: 1 - phi = delta (2 delta - bound) / (top + ...) < 3 delta^2 /
// epsilon^2.
TEST(Venkatakrishnan, LetsSmallWigglesPass) {
  const Real epsilon2 = 1e-4;
  for (const Real delta : {1e-4, -1e-4, 1e-5})
    for (const Real y : {0.0, 0.5, 1.0})
      EXPECT_NEAR(venkatakrishnan(delta, y * delta, epsilon2), 1, 3 * delta * delta / epsilon2);
}

TEST(Venkatakrishnan, DependsOnRatiosAlone) {
  for (const Real k : {1e-3, 1e3})
    EXPECT_NEAR(venkatakrishnan(k * 0.4, k * 0.3, k * k * 0.01), venkatakrishnan(0.4, 0.3, 0.01), 1e-15);
}

// Zhang & Shu 2010: the lowest face is moved to the bound, others by the same share; nothing else changes.
TEST(PositiveShare, LeavesEveryFaceHalf) {
  for (const Real lowest : {0.5, 0.8, 1.0}) EXPECT_EQ(positive_share(lowest), 1);
  for (const Real lowest : {0.4999, 0.2, 0.0, -1.0, -1e6})
    EXPECT_NEAR(1 + positive_share(lowest) * (lowest - 1), 0.5, 1e-9);
}

}  // namespace
}  // namespace alphadot
