// Where along the axis the moments balance, and the centre that a published set of moments was taken about.
#pragma once

#include <span>

#include "analysis/estimate.hpp"

namespace alphadot {

/// Static margin (x_neutral - x_center) / l = -Cm_alpha / CN_alpha about the centre: positive is stable.
Estimate static_margin(const Estimate& CN_alpha, const Estimate& Cm_alpha);

/// Static derivatives about a known centre at one Mach number, and what they ought to be about the unknown
/// one.
struct StaticPoint {
  Real CN_alpha = 0;
  Real Cm_alpha = 0;
  Real wanted_Cm_alpha = 0;
};

/// The unknown centre lies `dx` (reference lengths, positive aft) from the known one.
struct MomentCenterFit {
  Estimate dx;
  Real worst_misfit = 0;  ///< largest |Cm_alpha + dx CN_alpha - wanted| / |wanted|
};

/// Least squares over all points of the relative misfit, so that no Mach number outweighs the others.
/// Throws InputError for fewer than two points or a wanted value of zero.
MomentCenterFit fit_moment_center(std::span<const StaticPoint> points);

}  // namespace alphadot
