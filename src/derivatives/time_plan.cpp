#include "derivatives/time_plan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <tuple>

#include "core/fit_needs.hpp"

namespace alphadot {

namespace {

/// Share of the response up to which each step of a motion that is not harmonic is converged, relative to
/// unsteady.inner_tolerance: the deficit integral is a fraction of the response times the record.
constexpr Real response_share = 0.1;

/// Time steps while the slowest wave crosses the body.
constexpr Real least_steps_of_passage = 12;

/// t* in which it does.
Real passage_time(Real mach, const Configuration& configuration) {
  constexpr Real nearest = 0.01;  // to the speed of sound
  if (mach > 1)
    return 2 * mach / std::max(mach - 1, nearest) * (configuration.body.upper.x - configuration.body.lower.x);
  return 2 * std::max(mach / std::max(1 - mach, nearest), 2.0) * configuration.body_length;
}

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

std::string response_shortfall(const Case& settings, const Configuration& configuration) {
  const auto& [kind, unsteady] = std::tie(settings.motion.kind, settings.unsteady);
  const bool is_ramp = kind == MotionKind::ramp_alpha;
  if (!is_ramp && kind != MotionKind::step_alpha && kind != MotionKind::step_q) return {};
  const Real passage = passage_time(settings.freestream.mach, configuration);
  const Real recorded = is_ramp ? ramp_transient * unsteady.duration : unsteady.duration;
  constexpr Real told = 0.999;  // to the digits of what is told, which will then do
  if (recorded < told * passage)
    return fmt::format(
        "the response is not over: {}unsteady.duration = {:g} is less than the t* = {:.4g} in which "
        "the slowest wave crosses the body",
        is_ramp ? "half of " : "", unsteady.duration, passage);
  if (const Real steps = passage * unsteady.steps / unsteady.duration; steps < told * least_steps_of_passage)
    return fmt::format(
        "the time steps are too long for the response: {:.2g} while the slowest wave crosses the body, of "
        "{:g} "
        "that are needed; set unsteady.steps to {:.0f}",
        steps, least_steps_of_passage, std::ceil(least_steps_of_passage * unsteady.duration / passage));
  return {};
}

}  // namespace alphadot
