// Stability derivatives as AVL prints them, for the many programs that read its .st files.
#pragma once

#include <string>

#include "analysis/flight_point.hpp"

namespace alphadot {

/// Text in the manner of AVL's `ST` output (stability axes, per rad, rates with Cref = Bref = reference
/// length), with a block of its own for the acceleration derivatives. Columns that are not known are left
/// out. Throws InputError as to_stability_axes does.
std::string avl_stability_text(const FlightPoint& point);

}  // namespace alphadot
