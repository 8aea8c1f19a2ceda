// What a motion must be like for derivatives to be taken from it: asked of a case before it runs, and by the
// fits.
#pragma once

#include "core/types.hpp"

namespace alphadot {

/// Of a harmonic motion: cycles at its start that no fit uses, and the shortest window behind them.
inline constexpr Real discarded_cycles = 0.5, least_fitted_cycles = 1;
/// The highest multiple of the frequency in the fit; three, as the response of a symmetric body is odd.
inline constexpr int fitted_harmonics = 3;
/// A period of the highest harmonic takes more time steps than these.
inline constexpr int steps_per_harmonic = 4;
/// Of a step: samples, the one just after it included.
inline constexpr int least_step_samples = 12;
/// Of a ramp: samples after its start, which may take this share of the record.
inline constexpr int least_ramp_samples = 8;
inline constexpr Real ramp_transient = 0.5;

}  // namespace alphadot
