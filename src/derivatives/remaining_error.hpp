// How far linear functionals of an iterative solution may be from those of the exact one.
#pragma once

#include <span>
#include <vector>

#include "space/forces.hpp"

namespace alphadot {

/// Of the functionals at the latest of a solve's iterations; `norms` are those of its defects, `functionals`
/// over all ranks, both an entry an iteration, the start included. As many times the residual as those of any
/// earlier iteration were from the latest; this ratio is a sample, for residuals in some cells matter more to
/// a functional than in others. So the largest one counts, and more than once, the more often the fewer there
/// are. Each functional has a scale, what is a lot in its unit: by it, none is taken to be much less
/// sensitive than the most sensitive one, whatever its own samples say. Infinite for all when the residual
/// has dropped by less than two decades without being asked for no more than `orders`.
/// To all comes the share `inherited` of the scale, which the problem itself is wrong by.
std::vector<Real> remaining_error(std::span<const Real> norms, std::span<const std::vector<Real>> functionals,
                                  std::span<const Real> scales, Real relative_residual, Real orders,
                                  Real inherited = 0);

/// What derivatives about a steady flow are never surer than, as a share of their scale: flows bend where
/// limiter or flux turn from one side to the other. At an incidence 0.002 degrees off, derivatives of small
/// cones, wedges, wings and finners were different by up to 6e-6; the rest is margin for what was not tried.
inline constexpr Real bends = 5e-5;

/// Arm, in sizes of the body, by which forces count among moments where these are small about the centre
/// chosen.
inline constexpr Real moment_arm = 0.25;

/// Scales of the components of loads, the same for all: the size of `total`, for moments at least what its
/// force does on moment_arm, for forces at least what makes its moment on the size of the body: where
/// symmetry leaves a moment alone, as in roll, forces are no measure of anything.
std::vector<Real> scales_of(const Load& total, Real body_size, std::size_t loads);

/// The largest share of its scale that an error is.
Real relative_error(std::span<const Real> errors, std::span<const Real> scales);

}  // namespace alphadot
