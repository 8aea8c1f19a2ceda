#include "analysis/harmonic_derivatives.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <utility>

#include "core/error.hpp"
#include "march/time_levels.hpp"
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
      EXPECT_NEAR(found.estimated.at(Variable::alpha)[i].value, slopes[i], 1e-9) << coefficient_names[i];
      EXPECT_NEAR(found.estimated.at(Variable::alphadot)[i].value, rates[i], 1e-9) << coefficient_names[i];
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
    return harmonic_derivatives(swing, motion, {k}).estimated.at(variable).Cm.value;
  };
  EXPECT_NEAR(rate_of(MotionKind::pitch, Variable::q_plus_alphadot), -23, 1e-9);
  EXPECT_NEAR(rate_of(MotionKind::flap, Variable::q), -23, 1e-9);
  EXPECT_NEAR(rate_of(MotionKind::sway, Variable::betadot), -23, 1e-9);
  EXPECT_NEAR(rate_of(MotionKind::yaw, Variable::r_minus_betadot), 23, 1e-9);
  EXPECT_NEAR(rate_of(MotionKind::yaw, Variable::beta), -17, 1e-9);
  EXPECT_NEAR(rate_of(MotionKind::roll, Variable::p), -23, 1e-9);
  EXPECT_EQ(harmonic_derivatives(swing, MotionKind::flap, {k}).estimated.derivatives.size(), 1u);
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
      harmonic_derivatives(late, MotionKind::plunge, {k}).estimated.at(Variable::alphadot).Cm;
  EXPECT_NEAR(found.value - rates.Cm, 1.7, 1e-6);
  EXPECT_GE(found.uncertainty, 1.7 - 1e-6);
  EXPECT_LT(found.uncertainty, 2.5);
}

/// Share of one part in the uncertainty of an entry.
Real part(const EstimatedDerivatives& found, const std::string& source, Variable variable, int coefficient) {
  for (const auto& [name, share] : found.parts)
    if (name == source) return share.at(variable)[coefficient];
  ADD_FAILURE() << "no part " << source;
  return 0;
}

/// A moment that follows the angle with a lag, tau dX/dt* = slope angle - X, marched by the program's own
/// backward differences from rest through one and a half cycles; `fitted`: to the frequency.
ForceHistory marched(int steps_per_cycle, Real slope, Real tau, bool fitted) {
  ForceHistory out;
  out.time_step = period / steps_per_cycle;
  const Real scale = fitted ? fitted_step(out.time_step, k) : out.time_step;
  Real old = 0, older = 0;
  for (int step = 1; step <= 3 * steps_per_cycle / 2; ++step) {
    const Real time = step * out.time_step, angle = amplitude * std::sin(k * time);
    const TimeWeights weight = time_weights(step, scale);
    const Real now =
        (slope * angle - tau * (weight.old * old + weight.older * older)) / (1 + tau * weight.now);
    out.time.push_back(time);
    out.angle.push_back(angle);
    out.loads.push_back({.Cm = now});
    older = std::exchange(old, now);
  }
  return out;
}

// The exact response is slope / (1 + i k tau): Cm_alpha is its real part, k Cm_alphadot its imaginary one.
// Plain backward differences are off by theta^2 / 3 in Cm_alphadot, 4.9 % at 16 steps a cycle.
TEST(HarmonicDerivatives, TimeStepIsInTheUncertainty) {
  constexpr Real slope = -17, tau = 3;
  const Real alpha = slope / (1 + k * k * tau * tau), alphadot = -tau * alpha;
  for (const int steps : {16, 24, 48, 96}) {
    const auto found =
        harmonic_derivatives(marched(steps, slope, tau, true), MotionKind::plunge, {k}).estimated;
    const Real rate_error = std::abs(found.at(Variable::alphadot).Cm.value - alphadot),
               slope_error = std::abs(found.at(Variable::alpha).Cm.value - alpha);
    EXPECT_LE(rate_error, found.at(Variable::alphadot).Cm.uncertainty) << steps;
    EXPECT_LE(slope_error, 1.1 * part(found, "time_step", Variable::alpha, 4)) << steps;
    EXPECT_GE(slope_error, 0.5 * part(found, "time_step", Variable::alpha, 4)) << "far too wide, " << steps;
    EXPECT_LE(part(found, "time_step", Variable::alphadot, 4), 0.02 * alphadot);
    const auto plain =
        harmonic_derivatives(marched(steps, slope, tau, false), MotionKind::plunge, {k}).estimated;
    const Real theta = 2 * pi / steps;
    const Real too_fast = std::sin(theta) * (2 - std::cos(theta)) / theta - 1;  // theta^2 / 3 - ...
    EXPECT_NEAR(plain.at(Variable::alphadot).Cm.value / alphadot - 1, too_fast, 0.03 * too_fast);
    EXPECT_LT(rate_error, 0.05 * std::abs(plain.at(Variable::alphadot).Cm.value - alphadot)) << steps;
  }
}

// sin^3 = (3 sin - sin 3) / 4 and sin^2 cos = (cos - cos 3) / 4: terms cubic in the angle, and in the angle
// and its rate, put 3 c am^2 / 4 into the slope and d am^2 / 4 into the rate derivative.
TEST(HarmonicDerivatives, AmplitudeIsInTheUncertainty) {
  constexpr Real cubic = 4000, mixed = -9000;
  ForceHistory bent = history(test::times(1.5 * period, period / 48));
  for (std::size_t i = 0; i < bent.time.size(); ++i) {
    const Real swing = bent.angle[i] - mean, rate = k * amplitude * std::cos(k * bent.time[i]);
    bent.loads[i].Cm += cubic * std::pow(swing, 3) + mixed * swing * swing * rate;
  }
  const auto found = harmonic_derivatives(bent, MotionKind::plunge, {k}).estimated;
  const Real in_slope = 0.75 * cubic * amplitude * amplitude, in_rate = 0.25 * mixed * amplitude * amplitude;
  EXPECT_NEAR(found.at(Variable::alpha).Cm.value - slopes.Cm, in_slope, 1e-9);
  EXPECT_NEAR(found.at(Variable::alphadot).Cm.value - rates.Cm, in_rate, 1e-6);
  // What kinks would do, twice the cubic term.
  EXPECT_NEAR(part(found, "amplitude", Variable::alpha, 4), 2 * std::abs(in_slope), 1e-9);
  EXPECT_NEAR(part(found, "amplitude", Variable::alphadot, 4), 2 * std::abs(in_rate), 1e-6);
  // CN is linear, but nonlinear terms that cancel in its third harmonic would be in the others' too.
  EXPECT_NEAR(part(found, "amplitude", Variable::alpha, 2), 0.05 * 2 * std::abs(in_slope), 1e-9);
}

// Parts add up to the uncertainty.
TEST(HarmonicDerivatives, UncertaintyIsTheSumOfItsParts) {
  ForceHistory rough = history(test::times(1.7 * period, period / 32));
  rough.time_step = period / 32;
  for (std::size_t i = 0; i < rough.time.size(); ++i) {
    rough.loads[i].Cm += 1e-3 * std::sin(0.37 * static_cast<Real>(i * i));
    rough.loads[i].Cm += 1e-2 * (std::sin(3 * k * rough.time[i]) + std::cos(3 * k * rough.time[i]));
    rough.bounds.push_back({.Cm = 1e-5});
  }
  const auto found = harmonic_derivatives(rough, MotionKind::plunge, {k}).estimated;
  for (const auto variable : {Variable::alpha, Variable::alphadot}) {
    Real sum = 0;
    for (const auto& [source, share] : found.parts) {
      EXPECT_GT(share.at(variable).Cm, 0) << source;
      sum += share.at(variable).Cm;
    }
    EXPECT_NEAR(found.at(variable).Cm.uncertainty, sum, 1e-12 * sum);
  }
  EXPECT_EQ(found.parts.size(), 4u);
}

// 200 seeded trials with noise of 0.02 % of the static signal. The part of the fit may be three mean errors
// (95 % of a normal distribution are 2.5, and there is the difference of the half cycles); the third
// harmonic, as noisy as the first, counts six times in the slope and twice in the rate.
TEST(HarmonicDerivatives, UncertaintyCoversTheError) {
  test::Coverage slope, rate;
  for (unsigned seed = 1; seed <= 200; ++seed) {
    ForceHistory noisy = history(test::times((1.5 + seed / 150.0) * period, period / 48, 0.2, seed));
    std::vector<Real> noise(noisy.time.size(), 0.0);
    test::add_noise(noise, 2e-4 * 17 * amplitude, 0.5, seed);
    for (std::size_t i = 0; i < noise.size(); ++i) noisy.loads[i].Cm += noise[i];
    const auto found = harmonic_derivatives(noisy, MotionKind::plunge, {k}).estimated;
    slope.add(found.at(Variable::alpha).Cm, slopes.Cm);
    rate.add(found.at(Variable::alphadot).Cm, rates.Cm);
  }
  EXPECT_GE(slope.share(), 0.90);
  EXPECT_GE(rate.share(), 0.90);
  EXPECT_LT(slope.slack(), 3 + 6);
  EXPECT_LT(rate.slack(), 3 + 2);
}

}  // namespace
}  // namespace alphadot
