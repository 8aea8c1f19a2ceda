// The linear aerodynamic model of one flight condition for the flight simulator JSBSim.
#pragma once

#include <string>

#include "analysis/flight_point.hpp"

namespace alphadot {

/// An <aerodynamics> element on body axes (AXIAL aft, SIDE starboard, NORMAL up, ROLL PITCH YAW about the
/// standard body axes): X = X0 + X_alpha (alpha - alpha0) + X_beta (beta - beta0) + the rate terms, alphadot
/// and betadot among them, each with metrics/cbarw-ft / 2V. The vehicle's <metrics> must have chord =
/// reference length, wingarea = reference area and AERORP = moment centre: a comment in the element says so
/// with the numbers. The combined q + alphadot and r - betadot are left out: a simulator needs them apart.
std::string jsbsim_aerodynamics(const FlightPoint& point);

}  // namespace alphadot
