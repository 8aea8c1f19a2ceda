// Controls of a case: what is solved for, and what a set of them is made of.
#pragma once

#include <utility>
#include <vector>

#include "analysis/derivatives.hpp"
#include "derivatives/flow_case.hpp"
#include "derivatives/shape_change.hpp"

namespace alphadot {

/// Every control of a case, by itself.
std::vector<Variable> controls_of(const Case& settings);
/// Every set of controls of a case.
std::vector<Variable> control_sets_of(const Case& settings);

/// What a deflection of 1 rad is a sum of: of a set its controls, each by so many rad; of everything else
/// itself.
using Terms = std::vector<std::pair<Variable, Real>>;
Terms terms_of(Variable variable, const Case& settings);

/// Rates of all controls, when the case asks for them.
std::vector<Variable> control_rates_of(const Case& settings);
std::vector<Variable> control_set_rates_of(const Case& settings);  ///< and of all sets

/// What a deflection, or its rate, changes at the present flow of the case. Collective.
HeldFlowChange change_by_control(FlowCase& flow, Variable control, bool limiter_held);

}  // namespace alphadot
