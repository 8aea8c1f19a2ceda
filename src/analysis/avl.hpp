// Stability derivatives as AVL prints them, for the many programs that read its .st files.
#pragma once

#include <string>

#include "analysis/flight_point.hpp"

namespace alphadot {

/// Text in the manner of AVL's `ST` output (stability axes, per rad, rates with Cref = Bref = reference
/// length), for readers by key and for those by line and column: up to the neutral point every number stands
/// where AVL puts it, and is nan when it is not known. Blocks for the drag and the accelerations follow.
/// Throws InputError as to_stability_axes does.
std::string avl_stability_text(const FlightPoint& point);

}  // namespace alphadot
