// The two extrapolations: frequency to zero, mesh size to zero.
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "analysis/low_frequency.hpp"
#include "analysis/mesh_convergence.hpp"
#include "core/error.hpp"
#include "synthetic.hpp"

namespace alphadot {
namespace {

// X = -23 + 40 k^2: two values determine it.
TEST(LowFrequency, QuadraticFromTwoValues) {
  const std::vector<Real> k{0.1, 0.05};
  const std::vector<Estimate> x{{-23 + 40 * 0.01, 0}, {-23 + 40 * 0.0025, 0}};
  const Estimate limit = low_frequency_limit(k, x);
  EXPECT_NEAR(limit.value, -23, 1e-12);
  EXPECT_NEAR(limit.uncertainty, 40 * 0.0025, 1e-12) << "the extrapolation beyond k = 0.05";
}

// A term in k^4 is exact with three values; with two its error c4 k1^2 k2^2 is inside the uncertainty.
TEST(LowFrequency, QuarticNeedsThreeValues) {
  const auto x = [](Real k) { return Estimate{-23 + 40 * k * k - 900 * std::pow(k, 4), 0}; };
  const Estimate three =
      low_frequency_limit(std::vector<Real>{0.02, 0.1, 0.05}, std::vector{x(0.02), x(0.1), x(0.05)});
  EXPECT_NEAR(three.value, -23, 1e-12);
  const Estimate two = low_frequency_limit(std::vector<Real>{0.05, 0.1}, std::vector{x(0.05), x(0.1)});
  EXPECT_NEAR(two.value, -23 + 900 * 0.0025 * 0.01, 1e-12);
  EXPECT_LE(std::abs(two.value + 23), two.uncertainty);
}

// Weights at k and 2k are 4/3 and -1/3: uncertainties of 0.3 become 0.4 + 0.1.
TEST(LowFrequency, CarriesUncertaintiesAlong) {
  const std::vector<Estimate> x{{5, 0.3}, {5, 0.3}};
  EXPECT_NEAR(low_frequency_limit(std::vector<Real>{0.01, 0.02}, x).uncertainty, 0.5, 1e-12);
}

TEST(LowFrequency, Refuses) {
  const std::vector<Estimate> x{{1, 0}, {2, 0}};
  EXPECT_THROW(low_frequency_limit(std::vector<Real>{0.1}, std::span(x).first(1)), InputError);
  EXPECT_THROW(low_frequency_limit(std::vector<Real>{0.1, 0.1}, x), InputError);
  EXPECT_THROW(low_frequency_limit(std::vector<Real>{0, 0.1}, x), InputError);
  EXPECT_THROW(low_frequency_limit(std::vector<Real>{0.1, 0.2, 0.3}, x), InputError);
}

/// A mesh of `cells` with the value a + c h^p, h = cells^(-1/3).
MeshLevel level(GlobalIndex cells, Real a, Real c, Real p) {
  return {cells, a + c * std::pow(static_cast<Real>(cells), -p / 3)};
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
    EXPECT_EQ(found.safety_factor, 1.25);
    EXPECT_EQ(found.fine.value, levels[1].value);
    EXPECT_NEAR(found.fine.uncertainty, 1.25 * std::abs(levels[1].value + 23), 1e-6);
  }
}

// Celik et al., J. Fluids Eng. 130, 2008, 078001, table 1, first column: 18000, 8000 and 4500 cells in two
// dimensions give p = 1.53, phi_ext = 6.1685 and GCI = 2.2 % of phi_1 = 6.063, to the digits printed.
TEST(MeshConvergence, PublishedExample) {
  const auto found =
      mesh_convergence(std::vector<MeshLevel>{{18000, 6.063}, {8000, 5.972}, {4500, 5.863}}, 2);
  EXPECT_NEAR(found.order, 1.53, 0.01);
  EXPECT_NEAR(found.extrapolated, 6.1685, 1e-3);
  EXPECT_NEAR(found.fine.uncertainty / 6.063, 0.022, 5e-4);
}

// Two levels: order assumed, c h^2 with ratio 2 in h: error of the fine one is a third of the change,
// times 3.
TEST(MeshConvergence, TwoLevels) {
  const std::vector levels{level(100000, 10, 900, 2), level(800000, 10, 900, 2)};
  const auto found = mesh_convergence(levels);
  EXPECT_FALSE(found.observed);
  EXPECT_EQ(found.order, 2);
  EXPECT_NEAR(found.extrapolated, 10, 1e-12);
  EXPECT_NEAR(found.fine.uncertainty, std::abs(levels[0].value - levels[1].value), 1e-12);
}

// Two dimensions: h is the square root of the area of a cell.
TEST(MeshConvergence, Dimensions) {
  const std::vector<MeshLevel> levels{{100, 1 + 0.16}, {400, 1 + 0.04}};
  EXPECT_NEAR(mesh_convergence(levels, 2).extrapolated, 1, 1e-12);
}

// An oscillating sequence has no order: nothing is extrapolated and the largest change counts.
TEST(MeshConvergence, Oscillating) {
  const std::vector<MeshLevel> levels{{800000, 10}, {100000, 10.3}, {12500, 9.9}};
  const auto found = mesh_convergence(levels);
  EXPECT_FALSE(found.observed);
  EXPECT_EQ(found.safety_factor, 3);
  EXPECT_EQ(found.extrapolated, 10);
  EXPECT_NEAR(found.fine.uncertainty, 3 * 0.4 / 3, 1e-12);
}

// Order 0.6 where 2 is formal: not asymptotic, hence the larger factor. Order 4: cut to the formal 2.
TEST(MeshConvergence, OrderOutOfRange) {
  const std::vector slow{level(800000, 1, 5, 0.6), level(100000, 1, 5, 0.6), level(12500, 1, 5, 0.6)};
  EXPECT_NEAR(mesh_convergence(slow).order, 0.6, 1e-6);
  EXPECT_EQ(mesh_convergence(slow).safety_factor, 3);
  const std::vector fast{level(800000, 1, 5e5, 4), level(100000, 1, 5e5, 4), level(12500, 1, 5e5, 4)};
  EXPECT_EQ(mesh_convergence(fast).order, 2);
  EXPECT_GE(mesh_convergence(fast).fine.uncertainty, std::abs(fast[0].value - 1));
}

// Two of three levels that agree to a hundredth of the change before would have an order of 6.6.
TEST(MeshConvergence, AgreementByAccident) {
  const std::vector<MeshLevel> levels{{800000, 24.558}, {100000, 24.555}, {12500, 24.255}};
  const auto found = mesh_convergence(levels);
  EXPECT_FALSE(found.observed);
  EXPECT_EQ(found.extrapolated, 24.558);
  EXPECT_NEAR(found.fine.uncertainty, 3 * 0.303 / 3, 1e-12);
}

// 200 seeded sequences: order 1 to 2, a second term of the next order and 0.5 % noise.
TEST(MeshConvergence, UncertaintyCoversTheError) {
  test::Coverage coverage;
  for (unsigned seed = 1; seed <= 200; ++seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<Real> any(-1, 1);
    const Real p = 1.5 + 0.5 * any(random), second = 0.5 * any(random);
    std::vector<MeshLevel> levels;
    for (const GlobalIndex cells : {100000, 250000, 800000}) {
      const Real h = std::pow(static_cast<Real>(cells) / 100000, -1.0 / 3);
      levels.push_back({cells, -23 + 2 * std::pow(h, p) + second * std::pow(h, p + 1) + 0.01 * any(random)});
    }
    coverage.add(mesh_convergence(levels).fine, -23);
  }
  EXPECT_GE(coverage.share(), 0.90);
  EXPECT_LT(coverage.slack(), 6);
}

TEST(MeshConvergence, Refuses) {
  EXPECT_THROW(mesh_convergence(std::vector<MeshLevel>{{1000, 1}}), InputError);
  EXPECT_THROW(mesh_convergence(std::vector<MeshLevel>{{1000, 1}, {1000, 1.1}}), InputError);
  EXPECT_THROW(mesh_convergence(std::vector<MeshLevel>{{1000, 1}, {0, 1.1}}), InputError);
  EXPECT_THROW(mesh_convergence(std::vector<MeshLevel>(4, {1000, 1})), InputError);
}

}  // namespace
}  // namespace alphadot
