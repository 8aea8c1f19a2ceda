// Everything known about the aerodynamics at one flight condition.
#pragma once

#include <string>

#include "analysis/derivatives.hpp"
#include "core/flight.hpp"

namespace alphadot {

struct FlightPoint {
  std::string title;
  ReferenceSettings reference;
  FreestreamSettings freestream;
  Coefficients steady;        ///< on body axes
  DerivativeSet derivatives;  ///< on body axes, about reference.moment_center
  std::string origin = "";    ///< flow, mesh and program, on one line
  std::string status = "";    ///< of the run that computed them, and what was not reached
};

}  // namespace alphadot
