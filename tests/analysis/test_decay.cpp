// Free oscillations. Expectations: the sines that they were made of, with the trapezoidal rule's own roots.
#include "analysis/decay.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <random>

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

}  // namespace
}  // namespace alphadot
