// What flies, in which stream, and how it moves.
#pragma once

#include "core/flight.hpp"
#include "motion/settings.hpp"

namespace alphadot {

/// What stands between solver units and the coefficients and derivatives of a case.
struct FlightCondition {
  ReferenceSettings reference;
  FreestreamSettings freestream;
  MotionSettings motion;
};

}  // namespace alphadot
