// The cap on updates. Expectations: update.hpp's promise that neither density nor pressure changes by more
// than update_cap of itself.
#include "march/update.hpp"

#include <gtest/gtest.h>

namespace alphadot {
namespace {

const Primitive<Real> state{{2, 1, 0, 0, 0.5}};

TEST(CappedShare, LetsSmallUpdatesPass) {
  EXPECT_EQ(capped_share(state, {{0.29 * 2, 50, -50, 50, -0.29 * 0.5}}), 1);
  EXPECT_EQ(capped_share(state, {}), 1);
}

TEST(CappedShare, CutsByTheWorseOfDensityAndPressure) {
  EXPECT_DOUBLE_EQ(capped_share(state, {{-2, 0, 0, 0, 0.1}}), update_cap);
  EXPECT_DOUBLE_EQ(capped_share(state, {{0.1, 0, 0, 0, 1}}), update_cap / 2);
  EXPECT_DOUBLE_EQ(capped_share(state, {{-20, 0, 0, 0, -50}}), update_cap / 100);
}

}  // namespace
}  // namespace alphadot
