#include "derivatives/time_plan.hpp"

#include <cmath>

namespace alphadot {

namespace {

/// Share of the response up to which each step of a motion that is not harmonic is converged, relative to
/// unsteady.inner_tolerance: the deficit integral is a fraction of the response times the record.
constexpr Real response_share = 0.1;

}  // namespace

TimePlan time_plan(const Case& settings, const Motion& motion) {
  const UnsteadySettings& unsteady = settings.unsteady;
  const Real amplitude = motion.driven_amplitude();
  if (motion.is_harmonic())
    return {motion.period() / unsteady.steps_per_cycle,
            static_cast<int>(std::lround(unsteady.cycles * unsteady.steps_per_cycle)),
            {unsteady.inner_tolerance * settings.motion.reduced_frequency, amplitude, unsteady.max_inner}};
  return {motion.time_of(unsteady.duration) / unsteady.steps,
          unsteady.steps,
          {unsteady.inner_tolerance * response_share, amplitude, unsteady.max_inner}};
}

}  // namespace alphadot
