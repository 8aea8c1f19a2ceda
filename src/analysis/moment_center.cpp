#include "analysis/moment_center.hpp"

#include <algorithm>
#include <cmath>

#include "core/error.hpp"

namespace alphadot {

Estimate static_margin(const Estimate& CN_alpha, const Estimate& Cm_alpha) {
  const Real margin = -Cm_alpha.value / CN_alpha.value;
  return {margin,
          (Cm_alpha.uncertainty + std::abs(margin) * CN_alpha.uncertainty) / std::abs(CN_alpha.value)};
}

MomentCenterFit fit_moment_center(std::span<const StaticPoint> points) {
  const auto zero = [](const StaticPoint& p) { return p.wanted_Cm_alpha == 0; };
  if (points.size() < 2 || std::ranges::any_of(points, zero))
    throw InputError("", 0, "fit of the moment centre: needs two or more Mach numbers with a known Cm_alpha",
                     "compute the static derivatives at more of the published Mach numbers");
  // One unknown: minimise the sum of (g dx - m)^2 with g = CN_alpha / wanted, m = 1 - Cm_alpha / wanted.
  Real gg = 0, gm = 0;
  for (const auto& p : points) {
    const Real g = p.CN_alpha / p.wanted_Cm_alpha;
    gg += g * g;
    gm += g * (1 - p.Cm_alpha / p.wanted_Cm_alpha);
  }
  MomentCenterFit fit{.dx = {gm / gg, 0}};
  Real squares = 0;
  for (const auto& p : points) {
    const Real misfit = (p.Cm_alpha + fit.dx.value * p.CN_alpha) / p.wanted_Cm_alpha - 1;
    squares += misfit * misfit;
    fit.worst_misfit = std::max(fit.worst_misfit, std::abs(misfit));
  }
  fit.dx.uncertainty = 2 * std::sqrt(squares / static_cast<Real>(points.size() - 1) / gg);
  return fit;
}

}  // namespace alphadot
