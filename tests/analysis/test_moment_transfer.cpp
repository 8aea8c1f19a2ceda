#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "analysis/derivatives.hpp"
#include "core/error.hpp"

namespace alphadot {
namespace {

/// Longitudinal derivatives about one centre as the exact solutions list them.
struct Exact {
  Real CN_alpha, Cm_alpha, CN_q, Cm_q, CN_alphadot, Cm_alphadot, Cm_q_plus_alphadot;
};

/// The exact values as a set; `lateral` turns the body a quarter about its axis, up becoming starboard:
/// alpha -> -beta, q -> r, CN -> CY, Cm -> Cn.
DerivativeSet set_of(const Exact& e, bool lateral) {
  const auto column = [&](Real force, Real moment, Real sign) {
    CoefficientsOf<Estimate> out;
    (lateral ? out.CY : out.CN).value = sign * force;
    (lateral ? out.Cn : out.Cm).value = sign * moment;
    return out;
  };
  const Real combined_force = e.CN_q + e.CN_alphadot;
  if (lateral)
    return {{Variable::beta, column(e.CN_alpha, e.Cm_alpha, -1)},
            {Variable::r, column(e.CN_q, e.Cm_q, 1)},
            {Variable::betadot, column(e.CN_alphadot, e.Cm_alphadot, -1)},
            {Variable::r_minus_betadot, column(combined_force, e.Cm_q_plus_alphadot, 1)}};
  return {{Variable::alpha, column(e.CN_alpha, e.Cm_alpha, 1)},
          {Variable::q, column(e.CN_q, e.Cm_q, 1)},
          {Variable::alphadot, column(e.CN_alphadot, e.Cm_alphadot, 1)},
          {Variable::q_plus_alphadot, column(combined_force, e.Cm_q_plus_alphadot, 1)}};
}

void expect_equal(const DerivativeSet& found, const DerivativeSet& expected, Real tolerance) {
  ASSERT_EQ(found.size(), expected.size());
  for (const auto& [variable, values] : expected)
    for (int i = 0; i < Coefficients::size(); ++i)
      EXPECT_NEAR(found.at(variable)[i].value, values[i].value, tolerance)
          << derivative_name(coefficient_names[static_cast<std::size_t>(i)], variable);
}

// Both lines of exact_wedge_derivatives.csv: sharp wedge, half angle 5 deg, M 2, about 0 and 0.5 c, eight
// digits.
constexpr Exact wedge_apex{2.87112236,  -1.44654935, 2.76971654, -1.86061113,
                           -1.06425568, 0.71493451,  -1.14567661};
constexpr Exact wedge_middle{2.87112236,  -0.01098817, -0.10140582, -0.46476469,
                             -1.06425568, 0.18280668,  -0.28195801};
// Lines 3 and 4 of exact_cone_derivatives.csv: sharp 10 deg cone, M 2.5, lengths in d, about 0 and 2/3 of its
// length.
constexpr Exact cone_apex{1.81613895, -3.54002337, 8.40626993,  -18.43371676,
                          1.27829382, -2.80311082, -21.23682758};
constexpr Exact cone_thirds{1.81613895, -0.10674477, 1.53971272, -2.13868838,
                            1.27829382, -0.38658932, -2.52527770};

// 2e-8: the last digit of the table, times the few terms of the formula.
TEST(MomentTransfer, ExactWedge) {
  for (const bool lateral : {false, true})
    expect_equal(moment_transfer(set_of(wedge_apex, lateral), 0.5), set_of(wedge_middle, lateral), 3e-8);
}

TEST(MomentTransfer, ExactCone) {
  const Real length = 0.5 / std::tan(10 * radians_per_degree);  // of the cone, in d
  for (const bool lateral : {false, true})
    expect_equal(moment_transfer(set_of(cone_apex, lateral), 2 * length / 3), set_of(cone_thirds, lateral),
                 1.5e-6);  // six-digit x_ref_over_l times 18, twice
}

/// A body whose elements each feel their own relative wind w and answer with the force D w: derivatives
/// follow from rigid-body kinematics alone. V = 1, l = 1.
class Elements {
 public:
  explicit Elements(unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<Real> any(-1, 1);
    for (auto& element : elements_) {
      element.point = {5 * any(random), any(random), any(random)};
      for (auto& row : element.rows) row = {any(random), any(random), any(random)};
    }
  }

  DerivativeSet derivatives(const Vec3& centre) const {
    const auto turning = [&](const Vec3& rotation) {  // unit reduced rate = 2 V / l
      return loads(centre, [=](const Vec3& point) { return -2.0 * cross(rotation, point - centre); });
    };
    const auto blowing = [&](const Vec3& wind) { return loads(centre, [=](const Vec3&) { return wind; }); };
    return {{Variable::alpha, blowing({0, 0, 1})},
            {Variable::beta, blowing({0, -1, 0})},
            {Variable::p, turning({-1, 0, 0})},
            {Variable::q, turning({0, 1, 0})},
            {Variable::r, turning({0, 0, -1})}};
  }

 private:
  struct Element {
    Vec3 point, rows[3];
  };
  Element elements_[5];

  template <class Wind>
  CoefficientsOf<Estimate> loads(const Vec3& centre, Wind wind) const {
    Vec3 force, moment;
    for (const auto& element : elements_) {
      const Vec3 w = wind(element.point);
      const Vec3 push{dot(element.rows[0], w), dot(element.rows[1], w), dot(element.rows[2], w)};
      force += push;
      moment += cross(element.point - centre, push);
    }
    const Coefficients values = coefficients_of(force, moment);
    CoefficientsOf<Estimate> out;
    for (int i = 0; i < values.size(); ++i) out[i].value = values[i];
    return out;
  }
};

// Expected: the same body's derivatives computed anew with the other centre as axis. Every entry of the
// matrix, p and the coupled ones too.
TEST(MomentTransfer, RigidBodyKinematics) {
  const Elements body(7);
  expect_equal(moment_transfer(body.derivatives({0.4, 0, 0}), -1.7), body.derivatives({0.4 - 1.7, 0, 0}),
               1e-11);
}

TEST(MomentTransfer, RatesNeedTheStaticColumn) {
  DerivativeSet set = set_of(wedge_apex, false);
  set.erase(Variable::alpha);
  EXPECT_THROW(moment_transfer(set, 0.5), InputError);
}

// Expected: Cm_q of the same line of the exact wedge, which lists Cm_q, Cm_alphadot and their sum separately.
TEST(MomentTransfer, DampingBySubtraction) {
  DerivativeSet set = set_of(wedge_middle, false);
  set.erase(Variable::q);
  add_damping_by_subtraction(set);
  EXPECT_NEAR(set.at(Variable::q).Cm.value, wedge_middle.Cm_q, 3e-8);
  set.erase(Variable::alphadot);
  EXPECT_THROW(add_damping_by_subtraction(set), InputError);
}

}  // namespace
}  // namespace alphadot
