#include "analysis/harmonic_derivatives.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "core/error.hpp"
#include "synthetic.hpp"

namespace alphadot {
namespace {

constexpr Real k = 0.01;
constexpr Real period = 2 * pi / k;
constexpr Real mean = 1.5 * radians_per_degree, amplitude = 1 * radians_per_degree;

/// Loads of a body with the given slope and rate derivative of every coefficient, driven through
/// angle = mean + amplitude sin(k t* + phase); sizes as the Basic Finner's at M 2.5.
const Coefficients slopes{0.1, -9.0, 9.4, 0.2, -17, 16}, rates{0.3, 4.0, 5.5, -0.7, -23, 21};

ForceHistory history(const std::vector<Real>& times, Real phase = 0) {
  ForceHistory out;
  out.time = times;
  for (const Real t : times) {
    const Real swing = amplitude * std::sin(k * t + phase), rate = k * amplitude * std::cos(k * t + phase);
    out.angle.push_back(mean + swing);
    out.loads.push_back(Coefficients{0.45, 0, 0.25, 0, -0.44, 0} + swing * slopes + rate * rates);
  }
  return out;
}

// Expected: the derivatives that the history was made of; 1e-9 because the rate part is 1 % of the signal.
TEST(HarmonicDerivatives, PlungeWithAnyPhase) {
  for (const Real phase : {0.0, 0.4, pi / 2, 3.0}) {
    const auto found =
        harmonic_derivatives(history(test::times(1.7 * period, period / 48), phase), MotionKind::plunge, {k});
    for (int i = 0; i < Coefficients::size(); ++i) {
      EXPECT_NEAR(found.derivatives.at(Variable::alpha)[i].value, slopes[i], 1e-9) << coefficient_names[i];
      EXPECT_NEAR(found.derivatives.at(Variable::alphadot)[i].value, rates[i], 1e-9) << coefficient_names[i];
    }
    EXPECT_NEAR(found.mean_angle, mean, 1e-12);
    EXPECT_NEAR(found.amplitude, amplitude, 1e-12);
  }
}

// Expected from kinematics: pitch q = +alphadot; yaw about a fixed axis turns the nose into r = -betadot;
// flap and roll have no static part of their own.
TEST(HarmonicDerivatives, MeaningOfEachMotion) {
  const ForceHistory swing = history(test::times(1.5 * period, period / 48));
  const auto rate_of = [&](MotionKind motion, Variable variable) {
    return harmonic_derivatives(swing, motion, {k}).derivatives.at(variable).Cm.value;
  };
  EXPECT_NEAR(rate_of(MotionKind::pitch, Variable::q_plus_alphadot), -23, 1e-9);
  EXPECT_NEAR(rate_of(MotionKind::flap, Variable::q), -23, 1e-9);
  EXPECT_NEAR(rate_of(MotionKind::sway, Variable::betadot), -23, 1e-9);
  EXPECT_NEAR(rate_of(MotionKind::yaw, Variable::r_minus_betadot), 23, 1e-9);
  EXPECT_NEAR(rate_of(MotionKind::yaw, Variable::beta), -17, 1e-9);
  EXPECT_NEAR(rate_of(MotionKind::roll, Variable::p), -23, 1e-9);
  EXPECT_EQ(harmonic_derivatives(swing, MotionKind::flap, {k}).derivatives.size(), 1u);
  EXPECT_THROW(rate_of(MotionKind::step_alpha, Variable::alpha), InputError);
}

TEST(HarmonicDerivatives, WrongFrequencyIsRefused) {
  const ForceHistory swing = history(test::times(1.5 * period, period / 48));
  EXPECT_NO_THROW(harmonic_derivatives(swing, MotionKind::plunge, {k}));
  for (const Real wrong : {0.9 * k, 1.01 * k, 2 * k})
    EXPECT_THROW(harmonic_derivatives(swing, MotionKind::plunge, {wrong}), InputError) << wrong;
}

TEST(HarmonicDerivatives, MotionlessHistoryIsRefused) {
  ForceHistory still = history(test::times(1.5 * period, period / 48));
  for (Real& angle : still.angle) angle = mean;
  EXPECT_THROW(harmonic_derivatives(still, MotionKind::plunge, {k}), InputError);
}

// An inner iteration that stops early leaves the loads behind in time. A lag of one thousandth of a radian
// in Cm is 1e-3 * 17 / k = 1.7 of Cm_alphadot; the bound on each step must own up to it.
TEST(HarmonicDerivatives, InnerConvergenceBoundCoversALag) {
  const Real lag = 1e-3;
  const auto times = test::times(1.5 * period, period / 48);
  ForceHistory late = history(times);
  for (std::size_t i = 0; i < times.size(); ++i) {
    const Real error = -lag * slopes.Cm * amplitude * std::cos(k * times[i]);
    late.loads[i].Cm += error;
    late.bounds.push_back({.Cm = std::abs(error)});
  }
  const Estimate found =
      harmonic_derivatives(late, MotionKind::plunge, {k}).derivatives.at(Variable::alphadot).Cm;
  EXPECT_NEAR(found.value - rates.Cm, 1.7, 1e-6);
  EXPECT_GE(found.uncertainty, 1.7 - 1e-6);
  EXPECT_LT(found.uncertainty, 2.5);
}

// 200 seeded trials with noise of 0.02 % of the static signal.
TEST(HarmonicDerivatives, UncertaintyCoversTheError) {
  test::Coverage slope, rate;
  for (unsigned seed = 1; seed <= 200; ++seed) {
    ForceHistory noisy = history(test::times((1.5 + seed / 150.0) * period, period / 48, 0.2, seed));
    std::vector<Real> noise(noisy.time.size(), 0.0);
    test::add_noise(noise, 2e-4 * 17 * amplitude, 0.5, seed);
    for (std::size_t i = 0; i < noise.size(); ++i) noisy.loads[i].Cm += noise[i];
    const auto found = harmonic_derivatives(noisy, MotionKind::plunge, {k}).derivatives;
    slope.add(found.at(Variable::alpha).Cm, slopes.Cm);
    rate.add(found.at(Variable::alphadot).Cm, rates.Cm);
  }
  for (const auto& c : {slope, rate}) {
    EXPECT_GE(c.share(), 0.90);
    EXPECT_LT(c.slack(), 6);
  }
}

}  // namespace
}  // namespace alphadot
