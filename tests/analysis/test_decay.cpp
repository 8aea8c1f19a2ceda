// Free oscillations. Expectations: the sines that they were made of, with the trapezoidal rule's own roots.
#include "analysis/decay.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <random>
#include <tuple>
#include <utility>

#include "core/error.hpp"

namespace alphadot {
namespace {

struct Swing {
  Real damping = 0.002, k = 0.02, mean = 0.01, step = 4;
  int steps = 250;

  std::vector<Real> time() const {
    std::vector<Real> out;
    for (int i = 0; i <= steps; ++i) out.push_back(step * i);
    return out;
  }
  std::vector<Real> angle() const {
    std::vector<Real> out;
    for (const Real t : time()) out.push_back(mean + 0.03 * std::exp(-damping * t) * std::cos(k * t + 0.4));
    return out;
  }
};

TEST(Decay, FindsFrequencyAndDamping) {
  for (const Real damping : {0.002, 0.0, -0.001, 0.01}) {
    const Swing swing{.damping = damping};
    const auto found = fit_decay(swing.time(), swing.angle(), 0);
    EXPECT_NEAR(found.frequency.value, swing.k, 1e-9);
    EXPECT_NEAR(found.damping.value, damping, 1e-9);
    EXPECT_NEAR(found.mean.value, swing.mean, 1e-9);
    EXPECT_LT(found.frequency.uncertainty + found.damping.uncertainty, 1e-7);
    EXPECT_NEAR(found.cycles, (1000 - found.start) * swing.k / (2 * pi), 1e-6);
  }
}

TEST(Decay, TakesTheTimeStepOff) {
  const std::complex<Real> exact{-0.003, 0.02};
  const Real step = 8;
  const auto seen = 2 / step * std::atanh(step / 2 * exact);
  const Swing swing{.damping = -seen.real(), .k = seen.imag(), .step = step};
  const auto found = fit_decay(swing.time(), swing.angle(), step);
  EXPECT_NEAR(found.frequency.value, 0.02, 1e-9);
  EXPECT_NEAR(found.damping.value, 0.003, 1e-9);
  EXPECT_GE(found.frequency.uncertainty, std::abs(seen.imag() - 0.02));
  EXPECT_GE(found.damping.uncertainty, std::abs(seen.real() + 0.003));
}

TEST(Decay, CoversNoise) {
  std::mt19937 random(7);
  std::normal_distribution<Real> noise(0, 3e-4);
  int covered = 0;
  constexpr int trials = 40;
  for (int trial = 0; trial < trials; ++trial) {
    const Swing swing;
    auto angle = swing.angle();
    for (Real& a : angle) a += noise(random);
    const auto found = fit_decay(swing.time(), angle, 0);
    if (std::abs(found.frequency.value - swing.k) <= found.frequency.uncertainty &&
        std::abs(found.damping.value - swing.damping) <= found.damping.uncertainty)
      ++covered;
  }
  EXPECT_GE(covered, trials * 9 / 10);
}

// A frequency that drifts is no decaying sine: the half width says so.
TEST(Decay, SaysThatAMotionIsNotLinear) {
  const Swing swing;
  auto angle = swing.angle();
  const auto time = swing.time();
  for (std::size_t i = 0; i < angle.size(); ++i)
    angle[i] = 0.03 * std::cos(swing.k * (1 + 1e-4 * time[i]) * time[i]);
  const auto found = fit_decay(time, angle, 0);
  EXPECT_GT(found.frequency.uncertainty, 0.01 * swing.k);
}

/// y'' + k^2 (y + square y^2 + cube y^3) + (2 damping + fluid y^2) y' = 0 from rest at 1, integrated by the
/// classical method of Runge and Kutta.
struct Spring {
  Real k = 0.02, damping = 0.0004, square = 0, cube = 0, fluid = 0;

  Real acceleration(Real y, Real v) const {
    return -k * k * (y + square * y * y + cube * y * y * y) - (2 * damping + fluid * y * y) * v;
  }
  /// Angles, rates.
  std::pair<std::vector<Real>, std::vector<Real>> swing(const std::vector<Real>& time) const {
    constexpr int substeps = 20;
    std::vector<Real> angles{1}, rates{0};
    Real y = 1, v = 0;
    for (std::size_t i = 1; i < time.size(); ++i) {
      const Real h = (time[i] - time[i - 1]) / substeps;
      for (int j = 0; j < substeps; ++j) {
        const Real v2 = v + h / 2 * acceleration(y, v), a2 = acceleration(y + h / 2 * v, v2);
        const Real v3 = v + h / 2 * a2, a3 = acceleration(y + h / 2 * v2, v3);
        const Real v4 = v + h * a3, a4 = acceleration(y + h * v3, v4);
        const Real a1 = acceleration(y, v);
        y += h / 6 * (v + 2 * v2 + 2 * v3 + v4);
        v += h / 6 * (a1 + 2 * a2 + 2 * a3 + a4);
      }
      angles.push_back(y);
      rates.push_back(v);
    }
    return {angles, rates};
  }
};

// Of springs and dampers that are not linear the half widths hold what a small swing would have.
TEST(Decay, SaysWhatTheAmplitudeDoes) {
  const auto time = Swing{.step = 5, .steps = 190}.time();
  for (const Spring spring : {Spring{.cube = 0.1}, Spring{.cube = -0.1}, Spring{.square = 0.15},
                              Spring{.fluid = 0.001}, Spring{.damping = 0, .cube = 0.05, .fluid = 0.0005}}) {
    const auto found = fit_decay(time, spring.swing(time).first, 0);
    const Real exact = std::sqrt(spring.k * spring.k - spring.damping * spring.damping);
    const Real k_error = std::abs(found.frequency.value - exact),
               error = std::abs(found.damping.value - spring.damping);
    EXPECT_LE(k_error, found.frequency.uncertainty) << spring.cube << " " << spring.square;
    EXPECT_LE(error, found.damping.uncertainty) << spring.cube << " " << spring.fluid;
    EXPECT_LT(found.frequency.uncertainty, 10 * k_error + 2e-5);
    EXPECT_LT(found.damping.uncertainty, 10 * error + 4e-4);
  }
}

TEST(Decay, RefusesWhatDoesNotSwing) {
  const auto refuses = [](const Swing& swing, const std::string& why) {
    try {
      fit_decay(swing.time(), swing.angle(), 0);
      ADD_FAILURE() << "accepted: " << why;
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find(why), std::string::npos) << error.what();
    }
  };
  refuses({.steps = 90}, "cycles");
  refuses({.k = 0}, "does not swing");
  refuses({.steps = 10}, "too few");
  std::vector<Real> level(200, 0.1), time = Swing{.steps = 199}.time();
  EXPECT_THROW(fit_decay(time, level, 0), InputError);
}

TEST(Decay, GivesDerivativesOfFreePitch) {
  const Swing swing;
  ForceHistory history;
  history.time = swing.time();
  history.angle = swing.angle();
  std::vector<Real> rate;
  for (std::size_t i = 0; i < history.time.size(); ++i) {
    const Real t = history.time[i], phase = swing.k * t + 0.4;
    rate.push_back(0.03 * std::exp(-swing.damping * t) *
                   (-swing.damping * std::cos(phase) - swing.k * std::sin(phase)));
    Coefficients c;
    c.Cm = 0.2 - 17 * history.angle[i] - 310 * rate[i];
    c.CN = 9 * history.angle[i];
    history.loads.push_back(c);
  }
  history.time_step = swing.step;
  const auto found = free_pitch_derivatives(history, rate, fit_decay(history.time, history.angle, 0));
  EXPECT_NEAR(found.at(Variable::alpha).Cm.value, -17, 1e-8);
  EXPECT_NEAR(found.at(Variable::q_plus_alphadot).Cm.value, -310, 1e-6);
  EXPECT_NEAR(found.at(Variable::alpha).CN.value, 9, 1e-8);
  EXPECT_NEAR(found.at(Variable::q_plus_alphadot).CN.value, 0, 1e-6);
  EXPECT_NEAR(found.at(Variable::q_plus_alphadot).Cm.uncertainty, 310 * std::pow(0.02 * 4, 2) / 3, 1e-3);
}

TEST(Decay, DerivativesHaveThePartOfTheAmplitude) {
  const auto time = Swing{.step = 5, .steps = 190}.time();
  const Spring spring{.square = 0.05, .cube = 0.1, .fluid = 0.001};
  ForceHistory history;
  history.time = time;
  history.time_step = 5;
  std::vector<Real> rate;
  std::tie(history.angle, rate) = spring.swing(time);
  for (std::size_t i = 0; i < time.size(); ++i) {
    Coefficients c;
    c.Cm = spring.acceleration(history.angle[i], rate[i]);
    history.loads.push_back(c);
  }
  const auto found = free_pitch_derivatives(history, rate, fit_decay(time, history.angle, 0));
  const auto by_alpha = found.at(Variable::alpha).Cm, by_rate = found.at(Variable::q_plus_alphadot).Cm;
  EXPECT_GT(std::abs(by_alpha.value + spring.k * spring.k), 0.02 * spring.k * spring.k);
  EXPECT_LE(std::abs(by_alpha.value + spring.k * spring.k), by_alpha.uncertainty);
  EXPECT_LE(std::abs(by_rate.value + 2 * spring.damping), by_rate.uncertainty);
}

}  // namespace
}  // namespace alphadot
