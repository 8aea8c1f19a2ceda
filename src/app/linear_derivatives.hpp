// Derivatives of a case from linear solves about its steady flow.
#pragma once

#include <string>
#include <vector>

#include "analysis/derivatives.hpp"
#include "analysis/table.hpp"
#include "app/flow_case.hpp"

namespace alphadot {

/// Derivatives, and the parts that their uncertainties are the sums of.
struct EstimatedDerivatives {
  DerivativeSet derivatives;
  std::vector<UncertaintyPart> parts;

  /// Adds a part to the uncertainties.
  void add(std::string source, DerivativeSetOf<Real> share);
};

/// Solves for all derivatives about the steady flow that the case has marched to, with a checkpoint after
/// each group of them; those that its restart brings are taken from there. The parts are "linear", "steady"
/// and, when the case asks for it, "limiter". No derivatives when the run was stopped. Collective. Throws
/// DivergedError.
EstimatedDerivatives linear_derivatives(FlowCase& flow);

}  // namespace alphadot
