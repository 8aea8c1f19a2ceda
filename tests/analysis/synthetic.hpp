// Histories with known content, for the tests of the extractors.
#pragma once

#include <cmath>
#include <functional>
#include <random>
#include <vector>

#include "analysis/harmonic_derivatives.hpp"

namespace alphadot::test {

/// Times from 0 to `end` in steps of `step` (the last one may be shorter); with jitter, each step is
/// stretched at random by up to that share.
inline std::vector<Real> times(Real end, Real step, Real jitter = 0, unsigned seed = 1) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<Real> stretch(1 - jitter, 1 + jitter);
  std::vector<Real> out{0};
  while (out.back() < end - 1e-9 * step) {
    const Real next = out.back() + step * stretch(random);
    out.push_back(next < end - 0.5 * (1 - jitter) * step ? next : end);
  }
  return out;
}

inline std::vector<Real> sampled(const std::vector<Real>& times, const std::function<Real(Real)>& signal) {
  std::vector<Real> out;
  for (const Real time : times) out.push_back(signal(time));
  return out;
}

/// Adds first-order autoregressive noise: standard deviation `sigma`, correlation `rho` from step to step.
inline void add_noise(std::vector<Real>& signal, Real sigma, Real rho, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<Real> normal(0, 1);
  Real noise = normal(random);
  for (Real& value : signal) {
    value += sigma * noise;
    noise = rho * noise + std::sqrt(1 - rho * rho) * normal(random);
  }
}

/// How well stated uncertainties describe true errors over many trials.
class Coverage {
 public:
  void add(const Estimate& estimate, Real truth) {
    const Real error = std::abs(estimate.value - truth);
    ++trials_;
    covered_ += error <= estimate.uncertainty ? 1 : 0;
    errors_ += error;
    uncertainties_ += estimate.uncertainty;
  }
  /// Share of the trials whose uncertainty covers the error.
  Real share() const { return static_cast<Real>(covered_) / trials_; }
  /// Mean uncertainty over mean error: an uncertainty that covers by being huge is of no use.
  Real slack() const { return uncertainties_ / errors_; }

 private:
  int trials_ = 0, covered_ = 0;
  Real errors_ = 0, uncertainties_ = 0;
};

}  // namespace alphadot::test
