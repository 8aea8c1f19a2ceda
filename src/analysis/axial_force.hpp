// Parts of the axial force that inviscid flow does not have, by published correlations.
#pragma once

#include <span>

#include "core/types.hpp"

namespace alphadot {

/// Without a Reynolds number there is no estimate of friction.
struct EstimateSettings {
  Real reynolds = 0;    ///< of the free stream and the reference length
  Real transition = 0;  ///< Reynolds number along the walls at which boundary layers become turbulent
};

/// Walls taken together as a flat plate along the stream.
struct Plate {
  Real area;    ///< wetted, both sides; in reference areas
  Real length;  ///< along the stream; in reference lengths
};

/// Mean friction coefficient of a flat plate of a given Reynolds number (of its length, 1e4 or more) in air,
/// its wall adiabatic, laminar until the Reynolds number of transition: H. Blasius (1908) at E. R. G.
/// Eckert's reference temperature (J. Aero. Sci. 22, 1955), then E. R. van Driest's second theory (Aero. Eng.
/// Rev. 15, 1956), of what lies behind as if it had been turbulent from the start. Viscosity goes as T^0.76.
Real plate_friction(Real mach, Real reynolds, Real transition);

/// Axial force coefficient by the friction on some plates.
Real friction_force(std::span<const Plate> plates, Real mach, const EstimateSettings& settings);

/// Pressure coefficient on a blunt base while no motor burns, Mach 0 to 5: E. L. Fleeman, Tactical Missile
/// Design (AIAA, 2001), never below a vacuum's. Negative.
Real base_pressure(Real mach, Real gamma);

}  // namespace alphadot
