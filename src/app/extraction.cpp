#include "app/extraction.hpp"

#include <fmt/format.h>

#include "analysis/harmonic_derivatives.hpp"
#include "io/case_words.hpp"

namespace alphadot {

std::string motion_name(MotionKind kind) {
  for (const auto& [word, value] : words_of<MotionKind>)
    if (value == kind) return std::string(word);
  return "?";
}

namespace {

/// Column that the motion's angle is recorded in.
std::string angle_column(MotionKind kind) {
  switch (kind) {
    case MotionKind::sway:
    case MotionKind::yaw:
      return "beta";
    case MotionKind::flap:
      return "theta";
    case MotionKind::roll:
      return "phi";
    default:
      return "alpha";
  }
}

ForceHistory force_history(const History& history) {
  ForceHistory out;
  out.time = history.column("t_star");
  out.angle = history.column(angle_column(history.info.motion.kind));
  out.loads.resize(out.time.size());
  out.bounds.resize(out.time.size());
  for (int i = 0; i < Coefficients::size(); ++i) {
    const auto name = std::string(coefficient_names[static_cast<std::size_t>(i)]);
    const auto& values = history.column("total/" + name);
    const auto& bounds = history.column("error/" + name);
    for (std::size_t step = 0; step < values.size(); ++step) {
      out.loads[step][i] = values[step];
      out.bounds[step][i] = std::abs(bounds[step]);
    }
  }
  return out;
}

}  // namespace

Extraction extract_derivatives(const History& history) {
  const auto& motion = history.info.motion;
  const HarmonicBasis basis{.reduced_frequency = motion.reduced_frequency};
  return {harmonic_derivatives(force_history(history), motion.kind, basis).derivatives,
          fmt::format("harmonic fit, {}, k = {}", motion_name(motion.kind), motion.reduced_frequency)};
}

}  // namespace alphadot
