#include "analysis/axial_force.hpp"

#include <algorithm>
#include <cmath>

namespace alphadot {

namespace {

constexpr Real gamma_of_air = 1.4, prandtl = 0.71, viscosity_power = 0.76;

/// What an adiabatic wall is hotter than the stream, over its temperature.
Real heating(Real mach, Real recovery) {
  return 0.5 * recovery * (gamma_of_air - 1) * mach * mach;
}

Real laminar(Real mach, Real reynolds) {
  const Real recovery = std::sqrt(prandtl), hotter = heating(mach, recovery);
  const Real reference = 1 + 0.5 * hotter + 0.22 * hotter;  // temperature
  return 1.328 / std::sqrt(reynolds) * std::pow(reference, 0.5 * (viscosity_power - 1));
}

/// c of 0.242 asin(A) / (A sqrt(c T)) = log10(Re c) - 0.76 log10(T), T of the wall and A^2 = 1 - 1 / T.
Real turbulent(Real mach, Real reynolds) {
  const Real wall = 1 + heating(mach, std::cbrt(prandtl)), a = std::sqrt(1 - 1 / wall);
  const Real factor = 0.242 * (a > 0 ? std::asin(a) / a : 1) / std::sqrt(wall);
  const auto is_below = [&](Real c) {
    return factor / std::sqrt(c) > std::log10(reynolds * c) - viscosity_power * std::log10(wall);
  };
  Real low = 1e-8, high = 1;
  while (high > low * (1 + 1e-12)) {
    const Real middle = std::sqrt(low * high);
    (is_below(middle) ? low : high) = middle;
  }
  return low;
}

}  // namespace

Real plate_friction(Real mach, Real reynolds, Real transition) {
  if (reynolds <= transition) return laminar(mach, reynolds);
  const Real share = transition / reynolds;
  if (share == 0) return turbulent(mach, reynolds);
  return turbulent(mach, reynolds) - share * (turbulent(mach, transition) - laminar(mach, transition));
}

Real friction_force(std::span<const Plate> plates, Real mach, const EstimateSettings& settings) {
  Real out = 0;
  for (const Plate& plate : plates)
    if (plate.area > 0 && plate.length > 0)
      out += plate.area * plate_friction(mach, settings.reynolds * plate.length, settings.transition);
  return out;
}

Real base_pressure(Real mach, Real gamma) {
  const Real drag = mach < 1 ? 0.12 + 0.13 * mach * mach : 0.25 / mach;
  return -std::min(drag, 2 / (gamma * mach * mach));
}

}  // namespace alphadot
