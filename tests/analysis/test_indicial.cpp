#include "analysis/indicial.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <sstream>
#include <string>

#include "core/error.hpp"
#include "synthetic.hpp"

namespace alphadot {
namespace {

/// The exact response of a flat plate at M 2 to a unit step of alpha: CL and Cm about the leading edge.
ForceHistory exact_plate() {
  std::ifstream file(std::string(ALPHADOT_TEST_DATA) + "/exact_indicial_plate.csv");
  ForceHistory out;
  for (std::string line; std::getline(file, line);) {
    std::istringstream words(line);
    Real mach, at_over_c, ut_over_c, lift, moment;
    char comma;
    if (words >> mach >> comma >> at_over_c >> comma >> ut_over_c >> comma >> lift >> comma >> moment) {
      out.time.push_back(2 * ut_over_c);
      out.loads.push_back({.CN = lift, .Cm = moment});
    }
  }
  return out;
}

// Linear theory, low-frequency expansion of the plunging plate: Delta Cp = 4 alpha / beta - (8 x / beta^3)
// alphadot*, beta^2 = M^2 - 1, hence CL_alphadot = -4 / beta^3 and Cm_alphadot = 8 / (3 beta^3) about the
// leading edge; CL_alpha = 4 / beta, Cm_alpha = -2 / beta.
const Real beta = std::sqrt(3.0);
const Real lift_rate = -4 / std::pow(beta, 3), moment_rate = 8 / (3 * std::pow(beta, 3));

TEST(Indicial, ExactPlate) {
  ForceHistory plate = exact_plate();
  ASSERT_EQ(plate.time.size(), 57u);
  // From U t / c = 2 on the response is steady: the last line of the table holds on.
  for (int i = 1; i <= 80; ++i) {
    plate.time.push_back(plate.time.back() + 0.2);
    plate.loads.push_back(plate.loads.back());
  }
  const auto found = step_derivatives(plate, MotionKind::step_alpha, {}, 1);
  const auto &slope = found.at(Variable::alpha), &rate = found.at(Variable::alphadot);
  EXPECT_NEAR(slope.CN.value, 4 / beta, 1e-7);
  EXPECT_NEAR(slope.Cm.value, -2 / beta, 1e-7);
  // 57 straight lines in place of the curve.
  EXPECT_NEAR(rate.CN.value, lift_rate, 5e-4);
  EXPECT_NEAR(rate.Cm.value, moment_rate, 5e-4);
  EXPECT_LE(std::abs(rate.CN.value - lift_rate), rate.CN.uncertainty);
  EXPECT_LE(std::abs(rate.Cm.value - moment_rate), rate.Cm.uncertainty);
  EXPECT_LT(rate.CN.uncertainty, 5e-3);
}

// The table as it is ends just when the response becomes steady: a poor record must own up to it.
TEST(Indicial, RecordThatEndsEarlyIsUncertain) {
  const auto rate = step_derivatives(exact_plate(), MotionKind::step_alpha, {}, 1).at(Variable::alphadot).CN;
  EXPECT_LE(std::abs(rate.value - lift_rate), rate.uncertainty);
  EXPECT_GT(rate.uncertainty, 0.01);
}

// X = 2 - e^(-t / 3): final value 2, deficit 3, of which 3 e^(-T / 3) beyond the record. The extrapolation is
// exact for an exponential, the rest is the error of the trapezoidal rule, h^2 / 12 * slope < 1e-5.
TEST(Indicial, ExponentialTail) {
  for (const Real end : {12.0, 20.0, 30.0}) {
    const auto t = test::times(end, 0.02);
    const StepFit fit = fit_step(t, test::sampled(t, [](Real x) { return 2 - std::exp(-x / 3); }));
    EXPECT_NEAR(fit.final.value, 2, 1e-5) << end;
    EXPECT_NEAR(fit.deficit.value, 3, 3e-5) << end;
    EXPECT_NEAR(fit.tail, 3 * std::exp(-end / 3), 3e-5) << end;
    EXPECT_LE(std::abs(fit.deficit.value - 3), fit.deficit.uncertainty) << end;
  }
}

// Two time constants only: the limit cannot be told, but the uncertainty must hold it.
TEST(Indicial, UnfinishedResponseIsUncertain) {
  const auto t = test::times(6, 0.02);
  const StepFit fit = fit_step(t, test::sampled(t, [](Real x) { return 2 - std::exp(-x / 3); }));
  EXPECT_GT(std::abs(fit.final.value - 2), 0.01);
  EXPECT_LE(std::abs(fit.final.value - 2), fit.final.uncertainty);
  EXPECT_LE(std::abs(fit.deficit.value - 3), fit.deficit.uncertainty);
}

// First sample one step after the start, uneven steps: still the integral from zero, to first order in the
// step.
TEST(Indicial, StartsAtZeroWhateverTheFirstSample) {
  auto t = test::times(40, 0.01, 0.5);
  t.erase(t.begin());
  const StepFit fit = fit_step(t, test::sampled(t, [](Real x) { return 2 - std::exp(-x / 3); }));
  EXPECT_NEAR(fit.deficit.value, 3, 1e-4);
}

// 200 seeded trials of an exponential with white noise.
TEST(Indicial, UncertaintyCoversTheError) {
  test::Coverage final, deficit;
  for (unsigned seed = 1; seed <= 200; ++seed) {
    const auto t = test::times(20 + seed / 10.0, 0.1, 0.3, seed);
    auto y = test::sampled(t, [](Real x) { return 2 - std::exp(-x / 3); });
    test::add_noise(y, 1e-3, 0, seed);
    const StepFit fit = fit_step(t, y);
    final.add(fit.final, 2);
    deficit.add(fit.deficit, 3);
  }
  for (const auto& c : {final, deficit}) {
    EXPECT_GE(c.share(), 0.90);
    EXPECT_LT(c.slack(), 12);
  }
}

// Bounds of 1e-9 on every sample, less than the tail: the deficit can be off by 1e-9 T through X_final and as
// much through X.
TEST(Indicial, InnerConvergenceBound) {
  const auto t = test::times(60, 0.1);
  const auto y = test::sampled(t, [](Real x) { return 2 - std::exp(-x / 3); });
  const StepFit without = fit_step(t, y), with = fit_step(t, y, std::vector<Real>(t.size(), 1e-9));
  EXPECT_NEAR(with.final.uncertainty - without.final.uncertainty, 1e-9, 1e-15);
  EXPECT_NEAR(with.deficit.uncertainty - without.deficit.uncertainty, 2e-9 * 60, 1e-13);
}

// What the limiter leaves of a response that is over wanders: seeds whose three last means happen to look
// like an exponential must not be extrapolated. Noise of 1e-3, as seen; the response ended at t* = 10 of 60.
TEST(Indicial, TailThatIsOverIsNotExtrapolated) {
  const auto t = test::times(60, 0.1);
  const Real end = 2, deficit = 10;
  test::Coverage covered;
  int extrapolated = 0;
  for (unsigned seed = 1; seed <= 200; ++seed) {
    auto y = test::sampled(t, [](Real x) { return x < 10 ? x / 5 : 2; });
    test::add_noise(y, 1e-3, 0.9, seed);
    const StepFit fit = fit_step(t, y);
    extrapolated += fit.tail != 0 ? 1 : 0;
    covered.add(fit.deficit, deficit);
    EXPECT_NEAR(fit.final.value, end, 3e-3);
  }
  EXPECT_LE(extrapolated, 10) << "six means all go one way twice in 2^5";
  EXPECT_GE(covered.share(), 0.95);
}

// Changes within the bounds of the inner iterations are no tail either.
TEST(Indicial, TailBelowTheBoundsIsNotExtrapolated) {
  const auto t = test::times(20, 0.1);
  const auto y = test::sampled(t, [](Real x) { return 2 - std::exp(-x / 3); });
  EXPECT_NE(fit_step(t, y).tail, 0);
  EXPECT_NE(fit_step(t, y, std::vector<Real>(t.size(), 1e-5)).tail, 0);
  EXPECT_EQ(fit_step(t, y, std::vector<Real>(t.size(), 1e-2)).tail, 0);
}

// A step of q* = 0.02 from loads of 0.5 to 0.5 + 0.02 * 7: X_q = 7; alphadot does not take part.
TEST(Indicial, StepInPitchRate) {
  ForceHistory history;
  history.time = test::times(60, 0.1);
  for (const Real t : history.time) history.loads.push_back({.Cm = 0.5 + 0.02 * 7 * (1 - std::exp(-t / 2))});
  const auto found = step_derivatives(history, MotionKind::step_q, {.Cm = 0.5}, 0.02);
  EXPECT_EQ(found.derivatives.size(), 1u);
  EXPECT_NEAR(found.at(Variable::q).Cm.value, 7, 1e-6);
}

TEST(Indicial, RefusesWhatItCannotUse) {
  const auto t = test::times(2, 0.1);
  auto y = test::sampled(t, [](Real x) { return x; });
  EXPECT_THROW(fit_step(std::span(t).first(11), std::span(y).first(11)), InputError);
  EXPECT_THROW(fit_step(t, std::span(y).first(15)), InputError);
  auto repeated = t;
  repeated[5] = repeated[4];
  EXPECT_THROW(fit_step(repeated, y), InputError);
  y[3] = NAN;
  EXPECT_THROW(fit_step(t, y), InputError);
  const ForceHistory plate = exact_plate();
  EXPECT_THROW(step_derivatives(plate, MotionKind::plunge, {}, 1), InputError);
  EXPECT_THROW(step_derivatives(plate, MotionKind::step_alpha, {}, 0), InputError);
  ForceHistory torn = plate;
  torn.loads.pop_back();
  EXPECT_THROW(step_derivatives(torn, MotionKind::step_alpha, {}, 1), InputError);
}

}  // namespace
}  // namespace alphadot
