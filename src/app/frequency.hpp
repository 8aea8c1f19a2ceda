// The verb "frequency".
#pragma once

#include <vector>

#include "app/verbs.hpp"

namespace alphadot {

/// Steady state, then its linear responses to flight variables that oscillate at the reduced frequencies `k`
/// = omega length / 2V: alpha and q, on a full model beta, p and r too.
RunStatus frequency_verb(const CaseArguments& arguments, std::vector<Real> k, const Communicator& comm);

}  // namespace alphadot
