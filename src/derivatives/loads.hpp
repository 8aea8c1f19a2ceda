// Between loads in solver units and coefficients.
#pragma once

#include "analysis/coefficients.hpp"
#include "motion/flight_condition.hpp"
#include "space/forces.hpp"

namespace alphadot {

/// Divides by the dynamic pressure and the reference area (and length). A half model counts twice, and what
/// its mirror image cancels is zero.
inline Coefficients coefficients(const Load& load, const FlightCondition& settings) {
  const auto& reference = settings.reference;
  const Real scale = (reference.half_model ? 2 : 1) / (settings.dynamic_pressure() * reference.area);
  auto out = coefficients_of(scale * load.force, scale / reference.length * load.moment);
  if (reference.half_model) out.CY = out.Cl = out.Cn = 0;
  return out;
}

inline Real pressure_coefficient(Real pressure, const FlightCondition& settings) {
  return (pressure - 1 / settings.freestream.gamma) / settings.dynamic_pressure();
}

/// Work and energy per this are per dynamic pressure, reference area and reference length.
inline Real unit_work(const FlightCondition& settings) {
  return settings.dynamic_pressure() * settings.reference.area * settings.reference.length;
}

/// The transpose: what a coefficient, by its number, takes of each entry of a load.
inline Load coefficient_weight(int coefficient, const FlightCondition& settings) {
  Load out;
  for (int axis = 0; axis < 3; ++axis) {
    Load force, moment;
    force.force[axis] = moment.moment[axis] = 1;
    out.force[axis] = coefficients(force, settings)[coefficient];
    out.moment[axis] = coefficients(moment, settings)[coefficient];
  }
  return out;
}

}  // namespace alphadot
