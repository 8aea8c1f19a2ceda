#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <regex>
#include <set>
#include <utility>
#include <vector>

#include "analysis/cg_travel.hpp"
#include "analysis/moment_transfer.hpp"
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
    expect_equal(moment_transfer(set_of(wedge_apex, lateral), Vec3{0.5, 0, 0}), set_of(wedge_middle, lateral),
                 3e-8);
}

TEST(MomentTransfer, ExactCone) {
  const Real length = 0.5 / std::tan(10 * radians_per_degree);  // of the cone, in d
  for (const bool lateral : {false, true})
    expect_equal(moment_transfer(set_of(cone_apex, lateral), Vec3{2 * length / 3, 0, 0}),
                 set_of(cone_thirds, lateral),
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

  /// Loads per unit of wind along x over V.
  CoefficientsOf<Estimate> surge(const Vec3& centre) const {
    return loads(centre, [](const Vec3&) { return Vec3{1, 0, 0}; });
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
// matrix, p and the coupled ones too. Aside (y) the old centre surges with r, above (z) with q: those columns
// would need derivatives by speed and must not be there; all others must be exact.
TEST(MomentTransfer, RigidBodyKinematics) {
  const Elements body(7);
  const Vec3 old{0.4, -0.2, 0.3};
  struct Move {
    Vec3 offset;
    std::set<Variable> left_out;
  };
  for (const auto& [offset, left_out] :
       {Move{{-1.7, 0, 0}, {}}, Move{{-1.7, 0.6, 0}, {Variable::r}}, Move{{0, 0, -0.8}, {Variable::q}},
        Move{{2.1, 0.6, -0.8}, {Variable::q, Variable::r}}}) {
    DerivativeSet expected = body.derivatives(old + offset);
    for (const auto variable : left_out) expected.erase(variable);
    expect_equal(moment_transfer(body.derivatives(old), offset), expected, 1e-11);
  }
}

// The surge that is said to be missing is all that is missing: blown at along x by 2 z q*, the same body
// gives the column by q about a centre above.
TEST(MomentTransfer, SurgeIsWhatIsMissing) {
  const Elements body(11);
  const Real x = 1.3, z = 0.7;
  const auto old = body.derivatives({0, 0, 0}), about_new = body.derivatives({x, 0, z});
  const auto column = old.at(Variable::q) + -2 * x * old.at(Variable::alpha) + 2 * z * body.surge({0, 0, 0});
  expect_equal({{Variable::q, moment_transfer(column, Vec3{x, 0, z})}},
               {{Variable::q, about_new.at(Variable::q)}}, 1e-11);
}

/// A set in which the uncertainties are those of `parts`, in the order of the sources "linear" and "mesh".
EstimatedDerivatives estimated(unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<Real> any(0, 1);
  EstimatedDerivatives out;
  out.derivatives = Elements(seed).derivatives({0, 0, 0});
  for (const char* source : {"linear", "mesh"}) {
    DerivativeSetOf<Real> half_width;
    for (const auto& [variable, column] : out.derivatives)
      for (int i = 0; i < column.size(); ++i) half_width[variable][i] = any(random);
    out.add(source, std::move(half_width));
  }
  return out;
}

// Expected: magnitudes in the formula Cm_q' = Cm_q + x CN_q - 2 x (Cm_alpha + x CN_alpha), part by part, and
// parts that still add up to the whole.
TEST(MomentTransfer, PartsOfTheUncertainty) {
  const auto about_old = estimated(3);
  const Real x = -1.5;
  const auto moved = moment_transfer(about_old, Vec3{x, 0.2, 0});
  ASSERT_EQ(moved.parts.size(), 2);
  for (std::size_t part = 0; part < 2; ++part) {
    const auto& half_width = about_old.parts[part].half_width;
    EXPECT_EQ(moved.parts[part].source, about_old.parts[part].source);
    const Real expected = half_width.at(Variable::q).Cm + 1.5 * half_width.at(Variable::q).CN +
                          3 * (half_width.at(Variable::alpha).Cm + 1.5 * half_width.at(Variable::alpha).CN);
    EXPECT_NEAR(moved.parts[part].half_width.at(Variable::q).Cm, expected, 1e-14);
    EXPECT_FALSE(moved.parts[part].half_width.contains(Variable::r)) << "a surge";
  }
  for (const auto& [variable, column] : moved.derivatives)
    for (int i = 0; i < column.size(); ++i)
      EXPECT_NEAR(moved.parts[0].half_width.at(variable)[i] + moved.parts[1].half_width.at(variable)[i],
                  column[i].uncertainty, 1e-13);
}

// q about another centre holds derivatives by alpha, r those by beta; p only off the axis.
TEST(MomentTransfer, WhatRestsOnUnconvergedColumnsIsNot) {
  auto about_old = estimated(5);
  about_old.unconverged = {Variable::alpha};
  using enum Variable;
  EXPECT_EQ(moment_transfer(about_old, Vec3{0, 0, 0}).unconverged, (std::set{alpha}));
  EXPECT_EQ(moment_transfer(about_old, Vec3{1, 0, 0}).unconverged, (std::set{alpha, q}));
  EXPECT_EQ(moment_transfer(about_old, Vec3{0, 1, 0}).unconverged, (std::set{alpha, p}));
}

TEST(MomentTransfer, RatesNeedTheStaticColumn) {
  DerivativeSet set = set_of(wedge_apex, false);
  set.erase(Variable::alpha);
  EXPECT_THROW(moment_transfer(set, Vec3{0.5, 0, 0}), InputError);
  EXPECT_NO_THROW(moment_transfer(set, Vec3{0, 0, 0}));
}

TEST(Derivatives, NamesAreReadBack) {
  for (const std::string_view coefficient : coefficient_names)
    for (int v = 0; v <= static_cast<int>(Variable::r_minus_betadot); ++v) {
      const auto variable = static_cast<Variable>(v);
      const auto found = derivative_of_name(derivative_name(coefficient, variable));
      ASSERT_TRUE(found);
      EXPECT_EQ(coefficient_names[static_cast<std::size_t>(found->first)], coefficient);
      EXPECT_EQ(found->second, variable);
    }
  for (const char* other : {"Cm", "Cm_", "CL_alpha", "Cm_mach", "CN@fin_alpha", "_alpha", ""})
    EXPECT_FALSE(derivative_of_name(other)) << other;
}

// CN_alpha 10, Cm_alpha -5 about 0: margin 0.5 +- (0.1 + 0.5 * 0.2) / 10; the sum of the damping adds both
// uncertainties. Without q the sum is that of a forced pitch, or a dash.
TEST(CgTravel, Table) {
  DerivativeSet set;
  set[Variable::alpha].CN = {10, 0.2};
  set[Variable::alpha].Cm = {-5, 0.1};
  set[Variable::alphadot].Cm = {-3, 0.3};
  DerivativeSet pitch = set;
  set[Variable::q].Cm = {-40, 0.5};
  pitch[Variable::q_plus_alphadot].Cm = {-44, 0.25};
  const std::vector centers{AboutCenter{{0, 0, 0}, set}, AboutCenter{{1, 0, 0}, pitch}};
  const auto text = std::regex_replace(cg_travel_table(centers), std::regex(" +"), " ");
  EXPECT_EQ(text,
            " x_cg Cm_alpha ± Cm_q ± Cm_alphadot ± Cm_q+Cm_alphadot ± static margin ±\n"
            " 0 -5 ± 0.1 -40 ± 0.5 -3 ± 0.3 -43 ± 0.8 0.5 ± 0.02\n"
            " 1 -5 ± 0.1 - -3 ± 0.3 -44 ± 0.25 0.5 ± 0.02\n");
  const std::vector above{AboutCenter{{0, 0, 0}, set}, AboutCenter{{0, 0, 0.5}, {}}};
  const auto off_axis = std::regex_replace(cg_travel_table(above), std::regex(" +"), " ");
  EXPECT_TRUE(off_axis.starts_with(" x_cg y_cg z_cg Cm_alpha")) << off_axis;
  EXPECT_TRUE(off_axis.ends_with("\n 0 0 0.5 - - - - -\n")) << off_axis;
}

}  // namespace
}  // namespace alphadot
