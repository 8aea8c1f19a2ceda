// From a recorded history to derivatives.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <utility>

#include "analysis/decay.hpp"
#include "analysis/derivatives.hpp"
#include "io/history.hpp"
#include "motion/settings.hpp"

namespace alphadot {

struct Extraction {
  EstimatedDerivatives estimated;   ///< about the history's moment centre
  std::string method;               ///< "harmonic fit, plunge, k = 0.01"
  std::optional<Decay> decay = {};  ///< of a free flight
};

/// Derivatives of the whole configuration ("total") by the method that the history's motion allows. Throws
/// InputError when the history is too short; a motion by table yields none. The first row of a step or a ramp
/// holds the loads before it.
Extraction extract_derivatives(const History& history);

/// Of a free flight: how the incidence that pitch or yaw drives swings and, in pitch alone, derivatives.
Extraction extract_from_flight(const History& history, const BodySettings& body);

/// Rows [first, second) of a whole motion that the derivatives rest on; of a motion that yields none, all.
std::pair<std::size_t, std::size_t> fitted_rows(const History& history);

/// Derivatives from what a motion under way has recorded so far, to be shown, without uncertainty: of a
/// harmonic motion from six tenths of a cycle on, of its latest cycle at most. Empty where it is too early.
Extraction derivatives_so_far(const History& history);

}  // namespace alphadot
