// Extrapolation to a mesh size of zero.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>
#include <tuple>
#include <vector>

#include "analysis/mesh_convergence.hpp"
#include "core/error.hpp"
#include "synthetic.hpp"

namespace alphadot {
namespace {

/// A mesh of `cells` in a unit cube with the value a + c h^p.
MeshLevel level(Real cells, Real a, Real c, Real p) {
  const Real h = 1 / std::cbrt(cells);
  return {h, a + c * std::pow(h, p)};
}

// Manufactured a + c h^p with uneven refinement ratios: order and limit come back whatever the order of the
// levels.
TEST(MeshConvergence, ManufacturedOrder) {
  for (const Real p : {1.0, 1.4, 2.0}) {
    const std::vector levels{level(100000, -23, 500, p), level(800000, -23, 500, p),
                             level(250000, -23, 500, p)};
    const auto found = mesh_convergence(levels);
    EXPECT_TRUE(found.observed);
    EXPECT_NEAR(found.order, p, 1e-6);
    EXPECT_NEAR(found.extrapolated, -23, 1e-7);
  }
}

// Celik et al., J. Fluids Eng. 130, 2008, 078001, table 1, first column: 18000, 8000 and 4500 cells in two
// dimensions give p = 1.53 and phi_ext = 6.1685, to the digits printed.
TEST(MeshConvergence, PublishedExample) {
  const auto found = mesh_convergence(std::vector<MeshLevel>{
      {1 / std::sqrt(18000.0), 6.063}, {1 / std::sqrt(8000.0), 5.972}, {1 / std::sqrt(4500.0), 5.863}});
  EXPECT_NEAR(found.order, 1.53, 0.01);
  EXPECT_NEAR(found.extrapolated, 6.1685, 1e-3);
}

// Two levels: order assumed, c h^2.
TEST(MeshConvergence, TwoLevels) {
  const std::vector levels{level(100000, 10, 900, 2), level(800000, 10, 900, 2)};
  const auto found = mesh_convergence(levels);
  EXPECT_FALSE(found.observed);
  EXPECT_EQ(found.order, 2);
  EXPECT_NEAR(found.extrapolated, 10, 1e-12);
}

// An oscillating sequence has no order: nothing is extrapolated.
TEST(MeshConvergence, Oscillating) {
  const std::vector<MeshLevel> levels{{1, 10}, {2, 10.3}, {4, 9.9}};
  const auto found = mesh_convergence(levels);
  EXPECT_FALSE(found.observed);
  EXPECT_EQ(found.extrapolated, 10);
}

// Order 4 is cut to the formal 2, order 0.6 stands.
TEST(MeshConvergence, OrderOutOfRange) {
  const std::vector slow{level(800000, 1, 5, 0.6), level(100000, 1, 5, 0.6), level(12500, 1, 5, 0.6)};
  EXPECT_NEAR(mesh_convergence(slow).order, 0.6, 1e-6);
  const std::vector fast{level(800000, 1, 5e5, 4), level(100000, 1, 5e5, 4), level(12500, 1, 5e5, 4)};
  EXPECT_EQ(mesh_convergence(fast).order, 2);
}

// Two of three levels that agree to a hundredth of the change before would have an order of 6.6.
TEST(MeshConvergence, AgreementByAccident) {
  const std::vector<MeshLevel> levels{{1, 24.558}, {2, 24.555}, {4, 24.255}};
  const auto found = mesh_convergence(levels);
  EXPECT_FALSE(found.observed);
  EXPECT_EQ(found.extrapolated, 24.558);
}

TEST(MeshConvergence, Refuses) {
  EXPECT_THROW(mesh_convergence(std::vector<MeshLevel>{{1, 1}}), InputError);
  EXPECT_THROW(mesh_convergence(std::vector<MeshLevel>{{1, 1}, {1, 1.1}}), InputError);
  EXPECT_THROW(mesh_convergence(std::vector<MeshLevel>{{0, 1}, {1, 1.1}}), InputError);
  EXPECT_THROW(mesh_convergence(std::vector<MeshLevel>(4, {1, 1})), InputError);
}

/// A mesh of a half model with these values of CN and Cm by alpha, and of CN and Cm by alphadot.
MeshDerivatives half_model(Real spacing, std::array<Real, 4> values) {
  MeshDerivatives out{spacing, {}};
  out.derivatives[Variable::alpha].CN.value = values[0];
  out.derivatives[Variable::alpha].Cm.value = values[1];
  out.derivatives[Variable::alphadot].CN.value = values[2];
  out.derivatives[Variable::alphadot].Cm.value = values[3];
  return out;
}

// By hand. Spacings 1 and 2, so that a third of each difference is the error: 0.1, 0.2, 0.1, 0. About centres
// one length before and behind (a fifth of five) Cm by alpha is -6 and 2, whose root mean square is sqrt(20),
// that by alphadot 3 and 5, sqrt(17); forces are what they are. Errors by scales are 0.025, 0.0447, 0.1 and
// 0.
TEST(MeshUncertainty, OfTwoMeshesByHand) {
  const std::vector levels{half_model(1, {4, -2, 1, 4}), half_model(2, {4.3, -2.6, 0.7, 4})};
  const auto found = mesh_uncertainty(levels, 5);
  const Real relative = (0.1 / 4 + 0.2 / std::sqrt(20)) / 2;
  const auto expected = [&](Real error, Real scale) { return std::hypot(error, relative * scale); };
  const Real factor = found.at(Variable::alpha).CN / expected(0.1, 4);
  EXPECT_NEAR(factor, 2.75, 1e-12);
  EXPECT_NEAR(found.at(Variable::alpha).Cm, factor * expected(0.2, std::sqrt(20)), 1e-12);
  EXPECT_NEAR(found.at(Variable::alphadot).CN, factor * expected(0.1, 1), 1e-12);
  EXPECT_NEAR(found.at(Variable::alphadot).Cm, factor * expected(0, std::sqrt(17)), 1e-12);
  EXPECT_EQ(found.at(Variable::alpha).CA, 0);
}

// With c h^2 everywhere both pairs tell the same, and the levels may come in any order.
TEST(MeshUncertainty, OfThreeMeshesThatConverge) {
  const auto at = [](Real h) { return half_model(h, {4 + 0.1 * h * h, -2, 1, 4}); };
  const std::vector two{at(1), at(2)}, three{at(3), at(1), at(2)};
  const Real of_two = mesh_uncertainty(two, 5).at(Variable::alpha).CN,
             of_three = mesh_uncertainty(three, 5).at(Variable::alpha).CN;
  EXPECT_LT(of_three, of_two);
  EXPECT_GT(of_three, 0.1);
}

// Nothing depends on the reference length: ten times as long, forces stay, moments and rates by l / 2V are a
// tenth and so is the body's length in it.
TEST(MeshUncertainty, KnowsNoReferenceLength) {
  const std::vector levels{half_model(1, {4, -2, 1, 4}), half_model(2, {4.3, -2.6, 0.7, 4.2})};
  const std::vector longer{half_model(1, {4, -0.2, 0.1, 0.04}), half_model(2, {4.3, -0.26, 0.07, 0.042})};
  const auto a = mesh_uncertainty(levels, 5), b = mesh_uncertainty(longer, 0.5);
  EXPECT_NEAR(b.at(Variable::alpha).CN, a.at(Variable::alpha).CN, 1e-12);
  EXPECT_NEAR(b.at(Variable::alpha).Cm, a.at(Variable::alpha).Cm / 10, 1e-12);
  EXPECT_NEAR(b.at(Variable::alphadot).Cm, a.at(Variable::alphadot).Cm / 100, 1e-12);
}

// A body of revolution: what rolling does to it is zero but for the mesh, and says nothing about the rest.
TEST(MeshUncertainty, IsNotWidenedByWhatIsZero) {
  auto levels = std::vector{half_model(1, {4, -2, 1, 4}), half_model(2, {4.3, -2.6, 0.7, 4})};
  for (std::size_t i = 0; i < 2; ++i) {
    auto& set = levels[i].derivatives;
    set[Variable::q] = {.CN = {9, 0}, .Cm = {-30 + 0.3 * static_cast<Real>(i), 0}};
    set[Variable::p] = {};
  }
  const auto without = mesh_uncertainty(levels, 5);
  for (std::size_t i = 0; i < 2; ++i) {
    levels[i].derivatives[Variable::p].Cl.value = i == 0 ? 1e-6 : -2e-6;
    levels[i].derivatives[Variable::p].CY.value = i == 0 ? 1e-6 : -2e-6;
  }
  const auto with = mesh_uncertainty(levels, 5);
  for (const auto variable : {Variable::alpha, Variable::q, Variable::alphadot})
    EXPECT_NEAR(with.at(variable).Cm, without.at(variable).Cm, 1e-9);
}

/// A run on three meshes of a body whose derivatives by alpha and alphadot are 4, -2, 1 and 4: errors of some
/// per cent of them, of order 1 to 2, and a tenth of that as noise.
std::vector<MeshDerivatives> noisy_run(unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<Real> any;
  std::uniform_real_distribution<Real> order(1, 2);
  const std::array<Real, 4> exact{4, -2, 1, 4};
  std::array<Real, 4> size{}, p{};
  for (std::size_t k = 0; k < 4; ++k) {
    size[k] = 0.03 * exact[k] * any(random);
    p[k] = order(random);
  }
  std::vector<MeshDerivatives> out;
  for (const Real h : {1.0, 1.4, 2.0}) {
    auto values = exact;
    for (std::size_t k = 0; k < 4; ++k)
      values[k] += size[k] * std::pow(h, p[k]) + 0.003 * exact[k] * h * any(random);
    out.push_back(half_model(h, values));
  }
  return out;
}

// A third mesh that scatters must not punish who computed it; and the truth stays inside.
TEST(MeshUncertainty, IsNotWidenedByAThirdMeshAndCoversTheError) {
  test::Coverage one, two;
  for (unsigned seed = 1; seed <= 200; ++seed) {
    const auto levels = noisy_run(seed);
    const auto with_two = mesh_uncertainty(std::span(levels).first(2), 1),
               with_three = mesh_uncertainty(levels, 1);
    for (const auto& [variable, coefficient, exact] :
         {std::tuple{Variable::alpha, 2, 4.0}, std::tuple{Variable::alpha, 4, -2.0},
          std::tuple{Variable::alphadot, 2, 1.0}, std::tuple{Variable::alphadot, 4, 4.0}}) {
      const Real value = levels[0].derivatives.at(variable)[coefficient].value;
      one.add({value, with_two.at(variable)[coefficient]}, exact);
      two.add({value, with_three.at(variable)[coefficient]}, exact);
      EXPECT_LE(with_three.at(variable)[coefficient], with_two.at(variable)[coefficient]);
    }
  }
  EXPECT_GE(one.share(), 0.90);
  EXPECT_GE(two.share(), 0.90);
  EXPECT_LT(two.slack(), 6);
}

TEST(MeshUncertainty, Refuses) {
  const auto a = half_model(1, {4, -2, 1, 4});
  EXPECT_THROW(mesh_uncertainty(std::vector{a}, 5), InputError);
  EXPECT_THROW(mesh_uncertainty(std::vector{a, a}, 5), InputError);
}

}  // namespace
}  // namespace alphadot
