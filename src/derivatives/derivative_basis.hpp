// What solvers of linear problems about one steady flow rest on.
#pragma once

#include <functional>

#include "derivatives/settings.hpp"
#include "linear/linearisation.hpp"
#include "march/implicit_iteration.hpp"

namespace alphadot {

struct DerivativeBasis {
  /// About the flow of `iteration`, which must be steady under `conditions`. `go_on`, when given, is asked
  /// after each linear iteration, on every rank. Brings the ghosts of the flow up to date. Collective.
  DerivativeBasis(ImplicitIteration& iteration, const Conditions<Real>& conditions,
                  const DerivativeSettings& settings, std::function<bool()> go_on);

  ImplicitIteration& iteration;
  Linearisation linearisation;  ///< with the limiter free, as it is in a motion, whatever a march has frozen
  DerivativeSettings settings;
  std::function<bool()> go_on;
  Real body_size;  ///< diagonal of the box around the body
};

}  // namespace alphadot
