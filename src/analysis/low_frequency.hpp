// The limit k -> 0 of derivatives measured at finite reduced frequencies.
#pragma once

#include <span>

#include "analysis/estimate.hpp"

namespace alphadot {

/// Value at k = 0 of X(k) = X(0) + c2 k^2 + c4 k^4 + ..., the polynomial in k^2 through all given values.
/// In-phase and out-of-phase parts over k are even in k where the flow has a finite memory (supersonic; in
/// two-dimensional subsonic flow a term k^2 log k spoils it). Uncertainty: the given ones, carried along with
/// the worst signs, plus the change that the largest frequency made to the limit (for two values that is the
/// whole extrapolation beyond the lower one). `frequencies`: two or more, positive, no two equal. Throws
/// InputError otherwise.
Estimate low_frequency_limit(std::span<const Real> frequencies, std::span<const Estimate> values);

}  // namespace alphadot
