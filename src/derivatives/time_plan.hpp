// The time steps that follow a motion.
#pragma once

#include "derivatives/case.hpp"
#include "march/dual_time.hpp"
#include "motion/motion.hpp"

namespace alphadot {

/// How a case is marched in time.
struct TimePlan {
  Real time_step;  ///< in units of length over the free stream's sound speed
  int steps;
  InnerTolerance tolerance;
};
/// As [unsteady] states it: steps a cycle of a harmonic motion, of another the steps of its duration.
TimePlan time_plan(const Case& settings, const Motion& motion);

}  // namespace alphadot
