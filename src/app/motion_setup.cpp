#include "app/motion_setup.hpp"

#include <cmath>
#include <fstream>
#include <iterator>

#include "core/error.hpp"

namespace alphadot {

namespace {

/// Share of the response up to which each step of a motion that is not harmonic is converged, relative to
/// unsteady.inner_tolerance: the deficit integral is a fraction of the response times the record.
constexpr Real response_share = 0.1;

MotionTable read_table(const Case& settings, const Communicator& comm) {
  const std::string& file = settings.motion.table_file;
  std::string text;
  comm.on_root([&] {
    std::ifstream in(file, std::ios::binary);
    if (!in) throw InputError(file, 0, "the motion's table cannot be opened", "check motion.table_file");
    text.assign(std::istreambuf_iterator<char>(in), {});
  });
  text = comm.broadcast(text);
  MotionTable out;
  comm.on_all([&] {
    out = parse_motion_table(text, file);
    if (out.end < settings.unsteady.duration)
      throw InputError(file, 0,
                       "the table ends at t_star = " + std::to_string(out.end) + ", before unsteady.duration",
                       "add points or shorten the duration");
  });
  return out;
}

}  // namespace

Motion make_motion(const Case& settings, const Communicator& comm) {
  MotionTable table;
  if (settings.motion.kind == MotionKind::table) table = read_table(settings, comm);
  return Motion(settings.motion, settings.freestream, settings.reference.length, settings.unsteady.duration,
                std::move(table));
}

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
