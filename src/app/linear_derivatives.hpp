// Derivatives of a case from linear solves about its steady flow.
#pragma once

#include "analysis/derivatives.hpp"
#include "app/flow_case.hpp"

namespace alphadot {

/// Solves for all derivatives about the steady flow that the case has marched to, with a checkpoint after
/// each group of them; those that its restart brings are taken from there. The parts are "linear", "steady"
/// and, when the case asks for it, "limiter". Solves that do not reach their tolerance fall short. No
/// derivatives when the run was stopped. Collective. Throws DivergedError.
EstimatedDerivatives linear_derivatives(FlowCase& flow);

}  // namespace alphadot
