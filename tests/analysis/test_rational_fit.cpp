// Rational fits of frequency responses. Expectations: known rational functions; a delay, whose values between
// the frequencies are exact; the states' equation integrated in time.
#include "analysis/rational_fit.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "core/error.hpp"

namespace alphadot {
namespace {

using Complex = std::complex<Real>;

const std::vector<Real> frequencies{0.005, 0.01, 0.02, 0.05, 0.1, 0.15, 0.2, 0.3, 0.4, 0.5};

template <class Function>
std::vector<Complex> values(const Function& of, const std::vector<Real>& k = frequencies) {
  std::vector<Complex> out;
  for (const Real at : k) out.push_back(of(Complex{0, at}));
  return out;
}

TEST(RationalFit, FindsARationalFunction) {
  const auto one = [](Complex s) {
    return 3.0 + 0.2 / (s + 0.1) + (0.1 * s + 0.05) / ((s + 0.2) * (s + 0.2) + 0.09);
  };
  const auto other = [](Complex s) { return -1.0 + 0.4 / (s + 0.1); };
  const auto fit = fit_rational(frequencies, {values(one), values(other)}, 1e-6, 8);
  EXPECT_EQ(fit.states(), 3U);
  for (const Real error : fit.error) EXPECT_LT(error, 1e-6);
  for (const Real k : {0.0, 0.07, 0.25, 0.45}) {
    EXPECT_LT(std::abs(fit.at(0, k) - one({0, k})), 1e-4);
    EXPECT_LT(std::abs(fit.at(1, k) - other({0, k})), 1e-4);
  }
}

// A load that comes ten reference lengths late, which no rational function is: what it says of itself holds
// between the frequencies too, and the poles are stable.
TEST(RationalFit, StatesItsError) {
  const auto late = [](Complex s) { return 1.0 + 2.0 * std::exp(-20.0 * s); };
  std::vector<Real> k;
  for (int i = 0; i < 20; ++i) k.push_back(0.02 + 0.025 * i);
  for (const int most : {2, 4, 6, 8}) {
    const auto fit = fit_rational(k, {values(late, k)}, 1e-3, most);
    EXPECT_LE(fit.states(), static_cast<std::size_t>(most));
    for (const Complex pole : fit.poles) EXPECT_LT(pole.real(), 0);
    const Real said = std::max(fit.error[0], fit.error_between[0]);
    Real found = 0;
    for (Real at = k.front(); at < k.back(); at += 0.003)
      found = std::max(found, std::abs(fit.at(0, at) - late({0, at})) / 3);
    EXPECT_LE(found, 1.5 * said) << most;
  }
  EXPECT_LT(fit_rational(k, {values(late, k)}, 1e-3, 12).error[0], 0.02);
}

// An unstable response gets stable poles and says that they do not do.
TEST(RationalFit, IsStable) {
  const auto unstable = [](Complex s) { return 1.0 / (s - 0.1); };
  const auto fit = fit_rational(frequencies, {values(unstable)}, 1e-3, 4);
  for (const Complex pole : fit.poles) EXPECT_LT(pole.real(), 0);
  EXPECT_GT(fit.error[0], 0.01);
}

TEST(RationalFit, OfAConstantIsTheConstant) {
  const auto fit = fit_rational(frequencies, {values([](Complex) { return Complex{2.0}; })}, 1e-3, 4);
  EXPECT_EQ(fit.states(), 0U);
  EXPECT_NEAR(fit.direct[0], 2, 1e-12);
}

TEST(RationalFit, WantsFourFrequencies) {
  EXPECT_THROW(fit_rational(std::vector<Real>{0.1, 0.2, 0.3}, {{1, 1, 1}}, 1e-3, 4), InputError);
}

}  // namespace
}  // namespace alphadot
