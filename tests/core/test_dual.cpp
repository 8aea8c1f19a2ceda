// Dual numbers. Expectations: derivatives in closed form; tolerances are a few roundings of the value.
#include <gtest/gtest.h>

#include <cmath>

#include "core/dual.hpp"
#include "core/vec3.hpp"

namespace alphadot {
namespace {

constexpr Real rounding = 1e-14;  // relative: some 50 roundings

/// x and y as independent variables.
struct Dual2 : testing::Test {
  const Real a = 1.7, b = -0.6;
  Dual<2> x{a}, y{b};
  void SetUp() override {
    x.d[0] = 1;
    y.d[1] = 1;
  }
};

void expect_dual(const Dual<2>& found, Real value, Real dx, Real dy) {
  EXPECT_NEAR(found.v, value, rounding * (1 + std::abs(value)));
  EXPECT_NEAR(found.d[0], dx, rounding * (1 + std::abs(dx)));
  EXPECT_NEAR(found.d[1], dy, rounding * (1 + std::abs(dy)));
}

TEST_F(Dual2, AddsAndSubtracts) {
  expect_dual(x + y, a + b, 1, 1);
  expect_dual(x - y, a - b, 1, -1);
  expect_dual(-x, -a, -1, 0);
}

TEST_F(Dual2, MultipliesByTheProductRule) {
  expect_dual(x * y, a * b, b, a);
}

TEST_F(Dual2, DividesByTheQuotientRule) {
  expect_dual(x / y, a / b, 1 / b, -a / (b * b));
}

TEST_F(Dual2, MixesWithConstantsOnEitherSide) {
  expect_dual(x + 3.0, a + 3, 1, 0);
  expect_dual(3.0 + x, a + 3, 1, 0);
  expect_dual(x - 3.0, a - 3, 1, 0);
  expect_dual(3.0 - x, 3 - a, -1, 0);
  expect_dual(3.0 * x, 3 * a, 3, 0);
  expect_dual(x * 3.0, 3 * a, 3, 0);
  expect_dual(x / 3.0, a / 3, 1.0 / 3, 0);
  expect_dual(3.0 / x, 3 / a, -3 / (a * a), 0);
}

TEST_F(Dual2, AssignsInPlace) {
  Dual<2> z = x;
  z += y;
  z *= x;
  z -= y;
  z /= y;
  // ((x + y) x - y) / y = x^2 / y + x - 1
  expect_dual(z, a * a / b + a - 1, 2 * a / b + 1, -a * a / (b * b));
}

TEST_F(Dual2, SquaresItselfInPlace) {
  x *= x;
  expect_dual(x, a * a, 2 * a, 0);
  y /= y;
  expect_dual(y, 1, 0, 0);
}

TEST_F(Dual2, DifferentiatesRootsAndPowers) {
  expect_dual(sqrt(x), std::sqrt(a), 0.5 / std::sqrt(a), 0);
  expect_dual(pow(x, 2.5), std::pow(a, 2.5), 2.5 * std::pow(a, 1.5), 0);
  expect_dual(pow(x, -3.0), 1 / (a * a * a), -3 / (a * a * a * a), 0);
}

TEST_F(Dual2, FollowsTheSignInAbs) {
  expect_dual(abs(x), a, 1, 0);
  expect_dual(abs(y), -b, 0, -1);
}

TEST_F(Dual2, ChainsThroughAFormula) {
  // f = sqrt(x^2 + y^2) / (1 + x y); df by hand.
  const Dual<2> f = sqrt(x * x + y * y) / (1.0 + x * y);
  const Real r = std::hypot(a, b), q = 1 + a * b;
  expect_dual(f, r / q, a / (r * q) - r * b / (q * q), b / (r * q) - r * a / (q * q));
}

TEST_F(Dual2, ComparesValuesAlone) {
  Dual<2> same = x;
  same.d[1] = 42;
  EXPECT_TRUE(x <= same && x >= same);
  EXPECT_FALSE(x < same || x > same);
  EXPECT_TRUE(y < x && x > y);
  EXPECT_FALSE(x <= y || y >= x);
}

TEST_F(Dual2, GoesThroughVectors) {
  // u = (x, y, 0): d(u.u) = (2x, 2y); u x e_z = (y, -x, 0).
  const Vec3Of<Dual<2>> u{x, y, 0.0};
  expect_dual(dot(u, u), a * a + b * b, 2 * a, 2 * b);
  const auto turned = cross(u, Vec3{0, 0, 1});
  expect_dual(turned.x, b, 0, 1);
  expect_dual(turned.y, -a, -1, 0);
}

TEST(Dual, ConstantsHaveNoDerivative) {
  const Dual<3> c = 2.5;
  for (int k = 0; k < 3; ++k) EXPECT_EQ(c.d[k], 0);
  EXPECT_EQ(value_of(c), 2.5);
  EXPECT_EQ(value_of(2.5), 2.5);
}

}  // namespace
}  // namespace alphadot
