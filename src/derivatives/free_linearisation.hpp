// The linearisation that derivatives rest on.
#pragma once

#include "linear/linearisation.hpp"
#include "march/implicit_iteration.hpp"

namespace alphadot {

/// About the flow of an iteration with its limiter free, as it is in a motion, whatever a march has frozen.
/// Brings the ghosts of the flow up to date. Collective.
Linearisation linearise_with_free_limiter(ImplicitIteration& iteration, const Conditions<Real>& conditions);

}  // namespace alphadot
