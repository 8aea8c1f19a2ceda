#include "analysis/harmonic_fit.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/error.hpp"
#include "synthetic.hpp"

namespace alphadot {
namespace {

using test::add_noise;
using test::sampled;
using test::times;

constexpr Real k = 0.01;
constexpr Real period = 2 * pi / k;

/// Mean 0.3, fundamental (-0.2, 0.004), second harmonic (1e-3, -2e-3), drift: the numbers the tests look for.
Real signal(Real time, Real drift = 0) {
  const Real a = k * time;
  return 0.3 - 0.2 * std::sin(a) + 0.004 * std::cos(a) + 1e-3 * std::sin(2 * a) - 2e-3 * std::cos(2 * a) +
         drift * time / period;
}

// Every window length, whole cycles or not, gives the amplitudes back to round-off: what the fit's basis
// holds it must return, on any set of samples.
TEST(HarmonicFit, ExactOnAnyWindow) {
  for (const Real cycles : {1.5, 1.6, 1.83, 2.25, 3.0}) {
    const auto t = times(cycles * period, period / 48, 0.3);
    const auto fit = fit_harmonics({.reduced_frequency = k}, t, sampled(t, [](Real x) { return signal(x); }));
    EXPECT_NEAR(fit.mean.value, 0.3, 1e-13) << cycles;
    EXPECT_NEAR(fit.in_phase.value, -0.2, 1e-13) << cycles;
    EXPECT_NEAR(fit.out_of_phase.value, 0.004, 1e-13) << cycles;
    EXPECT_NEAR(fit.overtones.at(0)[0], 1e-3, 1e-13) << cycles;
    EXPECT_NEAR(fit.overtones.at(0)[1], -2e-3, 1e-13) << cycles;
    EXPECT_LT(fit.rms, 1e-13);
    EXPECT_NEAR(fit.cycles, cycles - 0.5, 1e-12) << "the first half cycle is left out";
  }
}

// Half a cycle, as a motion under way has it, determines mean and fundamental; nothing tells two halves
// apart.
TEST(HarmonicFit, HalfACycleWhereThatIsAllowed) {
  const auto pure = [](Real x) { return 0.3 - 0.2 * std::sin(k * x) + 0.004 * std::cos(k * x); };
  const HarmonicBasis basis{
      .reduced_frequency = k, .harmonics = 1, .discarded_cycles = 0.1, .least_cycles = 0.5};
  const auto t = times(0.6 * period, period / 48);
  const auto fit = fit_harmonics(basis, t, sampled(t, pure));
  EXPECT_NEAR(fit.in_phase.value, -0.2, 1e-12);
  EXPECT_NEAR(fit.out_of_phase.value, 0.004, 1e-12);
  EXPECT_EQ(fit.out_of_phase.half_cycles, 0);
  const auto less = times(0.55 * period, period / 48);
  EXPECT_THROW(fit_harmonics(basis, less, sampled(less, pure)), InputError);
}

// The paper's (7) has sine and cosine exchanged. Its (6), m = m0 + m_alpha am sin + m_alphadot k am cos,
// decides: a signal that is all sine is all static.
TEST(HarmonicFit, SineIsInPhase) {
  const auto t = times(1.5 * period, period / 48);
  const auto fit =
      fit_harmonics({.reduced_frequency = k}, t, sampled(t, [](Real x) { return std::sin(k * x); }));
  EXPECT_NEAR(fit.in_phase.value, 1, 1e-12);
  EXPECT_NEAR(fit.out_of_phase.value, 0, 1e-12);
}

// Over one whole cycle of even steps least squares equals the corrected integrals of the notes:
// X_alpha am = k / pi times the integral of X sin, by the rectangle rule, which is exact for a trigonometric
// sum.
TEST(HarmonicFit, EqualsTheFourierIntegralOverWholeCycles) {
  auto t = times(1.5 * period, period / 48);
  auto y = sampled(t, [](Real x) { return signal(x) + 1e-3 * std::sin(5 * k * x + 1); });
  t.pop_back();  // the window is half open: 48 samples of one cycle
  y.pop_back();
  const auto fit = fit_harmonics({.reduced_frequency = k, .discarded_cycles = 0.5 - 1.0 / 48}, t, y,
                                 std::vector<Real>(t.size(), 1.0));
  Real sine = 0, cosine = 0;
  for (std::size_t i = 0; i < 48; ++i) {
    const std::size_t j = t.size() - 1 - i;
    sine += 2.0 / 48 * y[j] * std::sin(k * t[j]);
    cosine += 2.0 / 48 * y[j] * std::cos(k * t[j]);
  }
  EXPECT_NEAR(sine, -0.2, 1e-13);
  // 49 samples were fitted, one of them twice in phase: the fifth harmonic leaves a trace, no more.
  EXPECT_NEAR(fit.in_phase.value, sine, 1e-4);
  EXPECT_NEAR(fit.out_of_phase.value, cosine, 1e-4);
}

TEST(HarmonicFit, DriftTerm) {
  const auto t = times(1.8 * period, period / 48, 0.2);
  const auto y = sampled(t, [](Real x) { return signal(x, 0.05); });
  const auto with = fit_harmonics({.reduced_frequency = k, .drift = true}, t, y);
  EXPECT_NEAR(with.drift, 0.05 / period, 1e-15);
  EXPECT_NEAR(with.in_phase.value, -0.2, 1e-12);
  EXPECT_NEAR(with.out_of_phase.value, 0.004, 1e-12);
  // Without the term the answer is off, and says so.
  const auto without = fit_harmonics({.reduced_frequency = k}, t, y);
  const Estimate in_phase = without.in_phase.estimate();
  EXPECT_GT(std::abs(in_phase.value + 0.2), 1e-3);
  EXPECT_LT(std::abs(in_phase.value + 0.2), in_phase.uncertainty);
}

// A start-up e^(-t/tau) of the size of the signal, dead after a few tau: with it inside the window the
// difference of the half cycles must show it; with the first half cycle discarded only e^(-pi / (k tau)) of
// it is left.
TEST(HarmonicFit, StartUpIsDiscardedAndSeen) {
  const auto t = times(1.5 * period, period / 96);
  const auto y = sampled(t, [](Real x) { return signal(x) + 0.1 * std::exp(-x / 30); });
  const auto fit = fit_harmonics({.reduced_frequency = k}, t, y);
  EXPECT_NEAR(fit.out_of_phase.value, 0.004, 0.1 * std::exp(-pi / (k * 30)));
  const auto all = fit_harmonics({.reduced_frequency = k, .discarded_cycles = 0}, t, y);
  const Real error = std::abs(all.out_of_phase.value - 0.004);
  EXPECT_GT(error, 1e-3);
  EXPECT_LT(error, all.out_of_phase.estimate().uncertainty);
}

// Worst case of bounded errors: an error of sign(cos) times the bound shifts the cosine amplitude by the mean
// of |cos| over the mean of cos^2, 4 / pi, and no other error shifts it more.
TEST(HarmonicFit, WorstCaseOfBoundedErrors) {
  const auto t = times(2.5 * period, period / 400);
  const std::vector<Real> bounds(t.size(), 1e-4);
  auto y = sampled(t, [](Real x) { return signal(x); });
  const auto clean = fit_harmonics({.reduced_frequency = k, .harmonics = 1}, t, y, {}, bounds);
  EXPECT_NEAR(clean.out_of_phase.samples, 4 / pi * 1e-4, 2e-7);
  for (std::size_t i = 0; i < t.size(); ++i) y[i] += std::copysign(1e-4, std::cos(k * t[i]));
  const auto shifted = fit_harmonics({.reduced_frequency = k, .harmonics = 1}, t, y, {}, bounds);
  const Real shift = shifted.out_of_phase.value - clean.out_of_phase.value;
  EXPECT_NEAR(shift, 4 / pi * 1e-4, 2e-7);
}

// A sample that weighs nothing cannot matter: a spike on it leaves the result as it is.
TEST(HarmonicFit, Weights) {
  const auto t = times(1.5 * period, period / 48);
  auto y = sampled(t, [](Real x) { return signal(x); });
  std::vector<Real> weights(t.size(), 1.0);
  y[60] += 1;
  weights[60] = 1e-12;
  const auto fit = fit_harmonics({.reduced_frequency = k}, t, y, weights);
  EXPECT_NEAR(fit.in_phase.value, -0.2, 1e-9);
  EXPECT_NEAR(fit.out_of_phase.value, 0.004, 1e-9);
}

/// 200 seeded trials: window of 1.5 to 3.1 cycles, uneven steps, random phase of the discarded start, noise
/// with the given correlation from step to step, a third harmonic that the basis does not hold.
std::array<test::Coverage, 2> coverage(Real rho, Real third_harmonic) {
  std::array<test::Coverage, 2> out;
  for (unsigned seed = 1; seed <= 200; ++seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<Real> any(0, 1);
    const Real cycles = 1.5 + 1.6 * any(random), third_phase = 2 * pi * any(random);
    const auto t = times(cycles * period, period / 48, 0.3, seed);
    auto y = sampled(
        t, [&](Real x) { return signal(x, 0.01) + third_harmonic * std::sin(3 * k * x + third_phase); });
    add_noise(y, 1e-3, rho, seed + 1000);
    const auto fit = fit_harmonics({.reduced_frequency = k, .harmonics = 2, .drift = true}, t, y);
    out[0].add(fit.in_phase.estimate(), -0.2);
    out[1].add(fit.out_of_phase.estimate(), 0.004);
  }
  return out;
}

TEST(HarmonicFit, UncertaintyCoversWhiteNoise) {
  for (const auto& c : coverage(0, 0)) {
    EXPECT_GE(c.share(), 0.90);
    EXPECT_LT(c.slack(), 6);
  }
}

TEST(HarmonicFit, UncertaintyCoversCorrelatedNoise) {
  for (const auto& c : coverage(0.7, 0)) {
    EXPECT_GE(c.share(), 0.90);
    EXPECT_LT(c.slack(), 6);
  }
}

TEST(HarmonicFit, UncertaintyCoversAMissingHarmonic) {
  for (const auto& c : coverage(0, 3e-3)) {
    EXPECT_GE(c.share(), 0.90);
    EXPECT_LT(c.slack(), 30);  // a misfit of one kind may harm by any, so this one is generous
  }
}

void expect_refused(const HarmonicBasis& basis, const std::vector<Real>& t, const std::vector<Real>& y,
                    const std::string& words) {
  try {
    fit_harmonics(basis, t, y);
    ADD_FAILURE() << "accepted, expected: " << words;
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find(words), std::string::npos) << error.what();
  }
}

TEST(HarmonicFit, RefusesWhatItCannotFit) {
  const auto sine = [](Real x) { return std::sin(k * x); };
  const auto t = times(1.5 * period, period / 48);
  const auto y = sampled(t, sine);
  const HarmonicBasis basis{.reduced_frequency = k};

  const auto short_times = times(1.3 * period, period / 48);
  expect_refused(basis, short_times, sampled(short_times, sine), "set unsteady.cycles = 1.5 or more");
  expect_refused(basis, {}, {}, "0.00 cycles");
  const auto coarse = times(1.5 * period, period / 6);
  expect_refused(basis, coarse, sampled(coarse, sine), "too long for multiple 3 of the frequency");
  const auto border = times(1.5 * period, period / 12);
  expect_refused(basis, border, sampled(border, sine), "set unsteady.steps_per_cycle = 13 or more");
  const auto enough = times(20 * period / 13, period / 13);
  EXPECT_NO_THROW(fit_harmonics(basis, enough, sampled(enough, sine)));
  expect_refused({.reduced_frequency = 0}, t, y, "not positive");
  expect_refused({.reduced_frequency = k, .harmonics = 0}, t, y, "fewer than one");
  expect_refused(basis, t, std::vector<Real>(t.size() - 1), "differ in length");

  auto broken = y;
  broken[3] = std::numeric_limits<Real>::quiet_NaN();
  expect_refused(basis, t, broken, "not finite");
  auto repeated = t;
  repeated[70] = repeated[69];
  expect_refused(basis, repeated, y, "do not increase");
}

}  // namespace
}  // namespace alphadot
