// Walls that turn about a hinge on a mesh that stays.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "march/deflection.hpp"
#include "space/discretization.hpp"

namespace alphadot {

/// The turned walls of a discretization once some patches have turned by an angle more, rad, and turn on at a
/// rate, rad per unit time.
std::vector<TurnedWall> turned_further(const Discretization& discretization,
                                       std::span<const std::string> patches, const Hinge& hinge, Real angle,
                                       Real rate = 0);

}  // namespace alphadot
