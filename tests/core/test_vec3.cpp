// Small vectors. Expectations: identities of vector algebra, by hand on small whole numbers (exact).
#include <gtest/gtest.h>

#include "core/five.hpp"
#include "core/vec3.hpp"

namespace alphadot {
namespace {

constexpr Vec3 a{1, -2, 3}, b{4, 5, -6}, c{-7, 8, 2};

void expect_equal(const Vec3& found, const Vec3& expected) {
  EXPECT_EQ(found.x, expected.x);
  EXPECT_EQ(found.y, expected.y);
  EXPECT_EQ(found.z, expected.z);
}

TEST(Vec3, AddsScalesAndTurnsRound) {
  expect_equal(a + b, {5, 3, -3});
  expect_equal(a - b, {-3, -7, 9});
  expect_equal(-a, {-1, 2, -3});
  expect_equal(2.0 * a, {2, -4, 6});
  Vec3 sum = a;
  sum += b;
  sum -= a;
  expect_equal(sum, b);
}

TEST(Vec3, IsIndexedByAxis) {
  Vec3 v;
  for (int i = 0; i < 3; ++i) v[i] = a[i];
  expect_equal(v, a);
}

TEST(Vec3, MultipliesByHand) {
  EXPECT_EQ(dot(a, b), 4 - 10 - 18);
  expect_equal(cross(a, b), {(-2) * (-6) - 3 * 5, 3 * 4 - 1 * (-6), 1 * 5 - (-2) * 4});
  EXPECT_EQ(norm(Vec3{2, -3, 6}), 7);
}

TEST(Vec3, CrossesRightHandedly) {
  expect_equal(cross(Vec3{1, 0, 0}, Vec3{0, 1, 0}), {0, 0, 1});
  expect_equal(cross(a, b), -cross(b, a));
}

TEST(Vec3, ObeysLagrangesIdentity) {
  expect_equal(cross(a, cross(b, c)), dot(a, c) * b - dot(a, b) * c);
}

TEST(Five, AddsAndScalesEveryEntry) {
  const Five<Real> p{{1, 2, 3, 4, 5}}, q{{10, 20, 30, 40, 50}};
  const auto sum = 2.0 * p + q, difference = q - p;
  for (int i = 0; i < 5; ++i) {
    EXPECT_EQ(sum[i], 12 * (i + 1));
    EXPECT_EQ(difference[i], 9 * (i + 1));
  }
}

}  // namespace
}  // namespace alphadot
