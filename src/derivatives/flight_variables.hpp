// The flight variables, and the changes of wind and grid motion that stand for them.
#pragma once

#include "analysis/derivatives.hpp"
#include "linear/tangent.hpp"
#include "motion/flight_condition.hpp"

namespace alphadot {

/// Change of wind and grid motion per unit of a flight variable: rad for angles, rad per unit time for rates;
/// none for the rates of the angles. The body moves across the wind, which itself stays: with alpha the body
/// sinks at V dalpha, normal to the flight path.
ConditionsChange change_of(Variable variable, const FreestreamSettings& stream);

/// The angle whose rate or second rate a variable is; itself for all others.
Variable angle_of(Variable variable);

/// How many time derivatives of angle_of() a variable is: 1 for alphadot, 2 for alphaddot, 0 for all others.
int rates_in(Variable variable);

/// What a derivative by a variable in radians per unit of time is multiplied by to be one by the reduced
/// variable: a power of 2 V / length.
Real rate_scale(Variable variable, const FlightCondition& settings);

}  // namespace alphadot
