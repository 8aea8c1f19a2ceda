// Least-squares fit of a sampled signal by a mean, a sine and cosine at a known frequency and its multiples.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "analysis/estimate.hpp"
#include "core/fit_needs.hpp"

namespace alphadot {

/// The basis 1, sin n(k t* + phase), cos n(k t* + phase) for n = 1 .. harmonics [, t*], on the samples after
/// the discarded start. t* = 2 V t / l is zero where the motion starts.
struct HarmonicBasis {
  Real reduced_frequency = 0;                          ///< k = omega l / (2V), so that the angle is k t*
  Real phase = 0;                                      ///< rad
  int harmonics = fitted_harmonics;                    ///< highest multiple of k
  bool drift = false;                                  ///< with a term linear in t*
  Real discarded_cycles = alphadot::discarded_cycles;  ///< the start-up that is left out
  Real least_cycles = least_fitted_cycles;             ///< shortest window that is fitted
};

/// A fitted amplitude and the three sources of its uncertainty, each about 95 %.
struct FittedAmplitude {
  Real value = 0;
  Real residual = 0;     ///< two standard errors from the covariance, residuals correlated in time
  Real half_cycles = 0;  ///< range of the values in the n half cycles over sqrt(n - 1); 0 for n < 2: unknown
  Real samples = 0;      ///< worst case of the given bounds on the samples (inner convergence)

  /// Random parts in quadrature; the worst case is added, for a lag in time acts on all samples alike.
  Estimate estimate() const;
};

struct HarmonicFit {
  Estimate mean;                               ///< at t* = 0 when there is a drift term
  FittedAmplitude in_phase;                    ///< of sin(k t* + phase)
  FittedAmplitude out_of_phase;                ///< of cos(k t* + phase)
  Real drift = 0;                              ///< per unit of t*
  std::vector<std::array<Real, 2>> overtones;  ///< sine and cosine amplitude of n = 2, 3, ...
  Real rms = 0;                                ///< of the residual
  Real cycles = 0;                             ///< length of the window that was fitted
};

/// Fits y(time). `time` (t*, increasing), `y` and `weights` (positive; empty: each sample weighs as its time
/// step, so that uneven steps act as in the Fourier integral) and `bounds` (largest error of each sample;
/// empty: none) have one entry a sample. The window need not be whole cycles, but holds basis.least_cycles.
/// Source: the paper's (7), with sine and cosine exchanged as its (6) demands, in least-squares form. Throws
/// InputError for a history that is too short, too coarse, not increasing in time or not finite.
HarmonicFit fit_harmonics(const HarmonicBasis& basis, std::span<const Real> time, std::span<const Real> y,
                          std::span<const Real> weights = {}, std::span<const Real> bounds = {});

}  // namespace alphadot
