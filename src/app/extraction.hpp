// From a recorded history to derivatives.
#pragma once

#include <string>

#include "analysis/derivatives.hpp"
#include "io/history.hpp"

namespace alphadot {

struct Extraction {
  DerivativeSet derivatives;  ///< about the history's moment centre
  std::string method;         ///< "harmonic fit, plunge, k = 0.01"
};

/// Derivatives of the whole configuration ("total") by the method that the history's motion allows. Throws
/// InputError when the history is too short; a motion by table yields none. The first row of a step or a ramp
/// holds the loads before it.
Extraction extract_derivatives(const History& history);

/// The same from what a motion under way has recorded so far, to be shown, without uncertainty: of a harmonic
/// motion from six tenths of a cycle on, of its latest cycle at most. Empty where it is too early.
Extraction derivatives_so_far(const History& history);

/// The word of the case file for a motion, "plunge".
std::string motion_name(MotionKind kind);

}  // namespace alphadot
