// The time steps that follow a motion.
#pragma once

#include <string>

#include "derivatives/case.hpp"
#include "march/dual_time.hpp"
#include "motion/motion.hpp"
#include "space/configuration.hpp"

namespace alphadot {

/// How a case is marched in time.
struct TimePlan {
  Real time_step;  ///< in units of length over the free stream's sound speed
  int steps;
  InnerTolerance tolerance;
};
/// As [unsteady] states it: steps a cycle of a harmonic motion, of another the steps of its duration.
TimePlan time_plan(const Case& settings, const Motion& motion);

/// Why no derivatives can be taken from a step or a ramp that is marched as [unsteady] says, however well
/// each time step converges; empty where they can. A response is not over before the slowest wave has crossed
/// the body: in a supersonic stream, along it, the sound that runs against it while it is carried away; in a
/// subsonic one, along the body's longest side, the sound that runs ahead, or twice the stream itself. A time
/// step that is too long for that wave does not follow the response.
std::string response_shortfall(const Case& settings, const Configuration& configuration);

}  // namespace alphadot
