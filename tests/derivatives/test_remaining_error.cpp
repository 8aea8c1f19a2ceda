// How far functionals of an unfinished solve may be off. Expectations: solves whose exact functionals are
// zero, each functional a known number times the residual.
#include "derivatives/remaining_error.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace alphadot {
namespace {

/// `iterations` steps, each of which divides the residual by `factor`.
struct Solve {
  Solve(int iterations, Real factor, const std::vector<Real>& times_residual) {
    for (int i = 0; i <= iterations; ++i) {
      norms.push_back(std::pow(factor, -i));
      auto& values = functionals.emplace_back();
      for (const Real times : times_residual) values.push_back(times * norms.back());
    }
  }
  std::vector<Real> error(const std::vector<Real>& scales, Real orders = 3, Real inherited = 0) const {
    return remaining_error(norms, functionals, scales, norms.back() / norms.front(), orders, inherited);
  }
  std::vector<Real> norms;
  std::vector<std::vector<Real>> functionals;
};

TEST(RemainingError, HoldsTheDistanceAndIsNoIdleOne) {
  const Solve solve(6, 4, {2, -0.5});
  const auto error = solve.error({1, 1});
  EXPECT_GT(error[0], 2 * std::abs(solve.functionals.back()[0]));
  EXPECT_LT(error[0], 10 * std::abs(solve.functionals.back()[0]));
  EXPECT_GT(error[1], 2 * std::abs(solve.functionals.back()[1]));
}

// Off by half as much as the other, in its own scale, though it has stood still.
TEST(RemainingError, OneThatStoodStillByChanceIsNoSurerThanTheOthers) {
  for (const Real scale : {1.0, 0.01}) {
    const Solve solve(6, 4, {2, 0});
    EXPECT_GT(solve.error({1, scale})[1], 0.5 * scale * 2 * solve.norms.back());
  }
}

TEST(RemainingError, FewIterationsTellLess) {
  const Solve few(1, 1000, {1}), many(10, std::pow(1000, 0.1), {1});
  EXPECT_GT(few.error({1})[0], 1.5 * many.error({1})[0]);
}

TEST(RemainingError, IsUnknownOfACutSolve) {
  const Solve cut(2, 3, {1, 0});
  for (const Real error : cut.error({1, 1})) EXPECT_TRUE(std::isinf(error));
  for (const Real error : cut.error({1, 1}, 0.9))
    EXPECT_TRUE(std::isfinite(error)) << "no more was asked for";
  const Solve nothing(3, 1.1, {1});
  EXPECT_TRUE(std::isinf(nothing.error({1}, 0.1)[0])) << "the residual has not halved";
}

TEST(RemainingError, HasWhatTheProblemIsWrongBy) {
  const auto error = Solve(6, 4, {1, 1}).error({10, 0}, 3, 0.2);
  EXPECT_GT(error[0], 2);
  EXPECT_LT(error[1], 0.1);
  EXPECT_TRUE(std::isinf(Solve(6, 4, {1}).error({1}, 3, INFINITY)[0]));
}

TEST(RemainingError, IsNothingOfNothing) {
  EXPECT_EQ(Solve(6, 4, {0, 0}).error({0, 0}), (std::vector<Real>{0, 0}));
}

// A moment about the centre of pressure is a small difference: what its force does on an arm counts.
TEST(Scales, OfLoads) {
  const Load load{{3, 0, 4}, {0, 0.1, 0}};
  const auto scales = scales_of(load, 8, 2);
  ASSERT_EQ(scales.size(), 12u);
  for (std::size_t i = 0; i < scales.size(); ++i) EXPECT_DOUBLE_EQ(scales[i], i % 6 < 3 ? 5 : 10);
  EXPECT_DOUBLE_EQ(relative_error(std::vector<Real>{1, 2, 0}, std::vector<Real>{10, 4, 0}), 0.5);
}

// Roll: forces that symmetry makes zero, but for round-off, must not make its moment unknown.
TEST(RemainingError, ScalesOfAMomentAlone) {
  const auto scales = scales_of({{1e-9, 0, 0}, {10, 0, 0}}, 5, 2);
  ASSERT_EQ(scales.size(), 12u);
  EXPECT_EQ(scales[0], 2);
  EXPECT_EQ(scales[3], 10);
  EXPECT_EQ(scales_of({{3, 0, 4}, {}}, 2, 1)[0], 5);
  EXPECT_EQ(scales_of({{3, 0, 4}, {}}, 2, 1)[3], 2.5);
}

}  // namespace
}  // namespace alphadot
