#include "analysis/axes.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "analysis/static_margin.hpp"
#include "core/error.hpp"

namespace alphadot {
namespace {

/// Loads on body axes as smooth functions of the flight variables; p and r about body axes.
Coefficients model(Real alpha, Real beta, Real p, Real r) {
  Coefficients out;
  for (int i = 0; i < out.size(); ++i)
    out[i] = std::cos(i + 2 * alpha) + 0.3 * i * beta + (1 + i) * p - (2 - 0.5 * i) * r;
  return out;
}

// Expected: central differences of the turned loads, alpha and its axes moving together, p' and r' about
// stability axes: p = p' cos - r' sin, r = p' sin + r' cos.
TEST(Axes, StabilityDerivativesEqualDifferences) {
  const Real alpha = 0.3, h = 1e-5;
  const auto difference = [&](auto loads) {
    CoefficientsOf<Estimate> out;
    const Coefficients slope = 1 / (2 * h) * (loads(h) - loads(-h));
    for (int i = 0; i < slope.size(); ++i) out[i].value = slope[i];
    return out;
  };
  const DerivativeSet body{{Variable::alpha, difference([&](Real d) { return model(alpha + d, 0, 0, 0); })},
                           {Variable::beta, difference([&](Real d) { return model(alpha, d, 0, 0); })},
                           {Variable::p, difference([&](Real d) { return model(alpha, 0, d, 0); })},
                           {Variable::r, difference([&](Real d) { return model(alpha, 0, 0, d); })}};
  const Real c = std::cos(alpha), s = std::sin(alpha);
  const auto turned = [&](Real d_alpha, Real beta, Real p, Real r) {
    return to_stability_axes(model(alpha + d_alpha, beta, p * c - r * s, p * s + r * c), alpha + d_alpha);
  };
  const DerivativeSet expected{{Variable::alpha, difference([&](Real d) { return turned(d, 0, 0, 0); })},
                               {Variable::beta, difference([&](Real d) { return turned(0, d, 0, 0); })},
                               {Variable::p, difference([&](Real d) { return turned(0, 0, d, 0); })},
                               {Variable::r, difference([&](Real d) { return turned(0, 0, 0, d); })}};
  const auto found = to_stability_axes(body, model(alpha, 0, 0, 0), alpha);
  for (const auto& [variable, values] : expected)
    for (int i = 0; i < values.size(); ++i)
      EXPECT_NEAR(found.at(variable)[i].value, values[i].value, 1e-8)
          << derivative_name(coefficient_names[static_cast<std::size_t>(i)], variable);
}

TEST(Axes, RollAndYawRateGoTogether) {
  const DerivativeSet only_roll{{Variable::p, {}}};
  EXPECT_THROW(to_stability_axes(only_roll, {}, 0.1), InputError);
  EXPECT_NO_THROW(to_stability_axes(only_roll, {}, 0));
}

// Moment transfer by the margin must make Cm_alpha vanish: that is what a neutral point is.
TEST(StaticMargin, IsWhereTheMomentVanishes) {
  const Estimate margin = static_margin({9.4, 0.1}, {-17, 0.2});
  EXPECT_NEAR(-17 + margin.value * 9.4, 0, 1e-14);
  EXPECT_NEAR(margin.value, 1.8085, 1e-4);
  // Worst signs of both: 17.2 / 9.3 - 17 / 9.4 = 0.0409, to first order.
  EXPECT_NEAR(margin.uncertainty, 0.0405, 5e-4);
}

}  // namespace
}  // namespace alphadot
