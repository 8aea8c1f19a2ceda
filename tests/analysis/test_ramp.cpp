#include "analysis/ramp.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "core/error.hpp"
#include "synthetic.hpp"

namespace alphadot {
namespace {

constexpr Real start_angle = 1.5 * radians_per_degree;
constexpr Real rate = 2e-4;  // alphadot l / 2V
const Coefficients initial{.CA = 0.45, .CN = 0.25, .Cm = -0.44};
const Coefficients slopes{.CA = 0.1, .CN = 9.4, .Cm = -17}, rates{.CA = 0.3, .CN = 5.5, .Cm = -23};

/// The ramp's exact response after a start-up that dies out as e^(-t* / 5).
ForceHistory history(Real noise = 0, unsigned seed = 1) {
  ForceHistory out;
  out.time = test::times(150, 1, 0.3, seed);
  std::vector<Real> errors(out.time.size(), 0.0);
  test::add_noise(errors, noise, 0.5, seed);
  for (std::size_t i = 0; i < out.time.size(); ++i) {
    const Real rise = rate * out.time[i], start_up = 1 - std::exp(-out.time[i] / 5);
    out.angle.push_back(start_angle + rise);
    out.loads.push_back(initial + rise * slopes + (rate * start_up) * rates);
    out.loads.back().Cm += errors[i];
  }
  return out;
}

// Expected: what the history was made of; of the start-up e^(-100 / 5) is left.
TEST(Ramp, SlopeAndIntercept) {
  const auto found = ramp_derivatives(history(), initial, start_angle, 100);
  for (int i = 0; i < Coefficients::size(); ++i) {
    EXPECT_NEAR(found.at(Variable::alpha)[i].value, slopes[i], 1e-7) << coefficient_names[i];
    EXPECT_NEAR(found.at(Variable::alphadot)[i].value, rates[i], 1e-6) << coefficient_names[i];
  }
}

// With the start-up inside the window the answer is off by several units, and the halves of the window show
// it.
TEST(Ramp, StartUpInsideTheWindowIsSeen) {
  const Estimate found = ramp_derivatives(history(), initial, start_angle, 2).at(Variable::alphadot).Cm;
  EXPECT_GT(std::abs(found.value - rates.Cm), 0.5);
  EXPECT_LE(std::abs(found.value - rates.Cm), found.uncertainty);
}

// A load that bends with alpha bends away from its tangent at the start: the extrapolation back to it is off,
// and only the difference of the halves of the window knows by how much.
TEST(Ramp, CurvatureIsSeen) {
  ForceHistory bent = history();
  for (std::size_t i = 0; i < bent.time.size(); ++i)
    bent.loads[i].Cm += 20 * std::pow(bent.angle[i] - start_angle, 2);
  const Estimate found = ramp_derivatives(bent, initial, start_angle, 60).at(Variable::alphadot).Cm;
  EXPECT_GT(std::abs(found.value - rates.Cm), 10);
  EXPECT_LE(std::abs(found.value - rates.Cm), found.uncertainty);
  EXPECT_LT(found.uncertainty, 100);
}

// 200 seeded trials, correlated noise of 2 % of the alphadot part.
TEST(Ramp, UncertaintyCoversTheError) {
  test::Coverage slope, intercept;
  for (unsigned seed = 1; seed <= 200; ++seed) {
    const auto found = ramp_derivatives(history(0.02 * 23 * rate, seed), initial, start_angle, 60);
    slope.add(found.at(Variable::alpha).Cm, slopes.Cm);
    intercept.add(found.at(Variable::alphadot).Cm, rates.Cm);
  }
  for (const auto& c : {slope, intercept}) {
    EXPECT_GE(c.share(), 0.90);
    EXPECT_LT(c.slack(), 12);
  }
}

// Every sample off by +b at most: a constant error of b moves the intercept by b / rate.
TEST(Ramp, InnerConvergenceBound) {
  ForceHistory bounded = history();
  const auto without = ramp_derivatives(bounded, initial, start_angle, 60).at(Variable::alphadot).Cm;
  bounded.bounds.assign(bounded.time.size(), {.Cm = 1e-6});
  const auto with = ramp_derivatives(bounded, initial, start_angle, 60).at(Variable::alphadot).Cm;
  EXPECT_GE(with.uncertainty - without.uncertainty, 1e-6 / rate);
}

TEST(Ramp, RefusesWhatIsNoRamp) {
  EXPECT_THROW(ramp_derivatives(history(), initial, start_angle, 145), InputError) << "too few samples";
  ForceHistory held = history();
  for (std::size_t i = 0; i < held.time.size(); ++i)
    held.angle[i] = start_angle + rate * std::min(held.time[i], 120.0);
  EXPECT_THROW(ramp_derivatives(held, initial, start_angle, 60), InputError) << "held at the end";
  for (Real& angle : held.angle) angle = start_angle;
  EXPECT_THROW(ramp_derivatives(held, initial, start_angle, 60), InputError) << "no motion";
}

}  // namespace
}  // namespace alphadot
