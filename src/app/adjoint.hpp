// The verb "adjoint".
#pragma once

#include <string>
#include <vector>

#include "app/verbs.hpp"

namespace alphadot {

/// Steady state, then the adjoints of loads: `of` names them ("Cm", "Cm_alphadot", "CN@fin_1+fin_2"; none:
/// all coefficients). Writes their derivatives, and the fields that show which cells a load listens to.
RunStatus adjoint_verb(const CaseArguments& arguments, const std::vector<std::string>& of,
                       const Communicator& comm);

}  // namespace alphadot
