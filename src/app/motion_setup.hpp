// From the case to a motion and the time steps that follow it.
#pragma once

#include "app/setup.hpp"
#include "march/dual_time.hpp"
#include "motion/motion.hpp"

namespace alphadot {

/// The motion of a case.
Motion make_motion(const Setup& setup);

/// How a case is marched in time.
struct TimePlan {
  Real time_step;
  int steps;
  InnerTolerance tolerance;
};
TimePlan time_plan(const Case& settings, const Motion& motion);

}  // namespace alphadot
