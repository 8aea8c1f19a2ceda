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

  /// 2 V / length: a reduced rate in radians per unit of time; the speed of sound is 1.
  Real unit_rate() const { return 2 * freestream.mach / reference.length; }
  /// Of the free stream.
  Real dynamic_pressure() const { return 0.5 * freestream.mach * freestream.mach; }
};

}  // namespace alphadot
