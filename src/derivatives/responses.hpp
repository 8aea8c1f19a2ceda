// What a case is solved for about its steady flow, and the responses.
#pragma once

#include <compare>
#include <map>
#include <optional>
#include <span>
#include <vector>

#include "analysis/derivatives.hpp"
#include "derivatives/flow_case.hpp"
#include "derivatives/sensitivity.hpp"
#include "derivatives/shape_change.hpp"

namespace alphadot {

/// What was solved for, and whether the limiter's factors were held meanwhile.
struct ResponseKey {
  Variable variable;
  bool limiter_held = false;
  auto operator<=>(const ResponseKey&) const = default;
};
using Responses = std::map<ResponseKey, Sensitivity>;

/// Variables that are solved for together, in this order: angles and rotations, then the rates of the angles,
/// then their rates; at last the controls, and their rates.
std::vector<std::vector<Variable>> groups_of(const Case& settings);

/// All that there are derivatives by: what is solved for, and the sets of controls.
std::vector<Variable> variables_of(const Case& settings);

/// What a variable is the rate of.
std::optional<Variable> rate_of(Variable variable);

/// The problem of one variable.
struct ResponseProblem {
  SensitivityProblem problem;
  std::optional<HeldFlowChange> held = {};  ///< of a control, which `problem` is to refer to
};

/// About the present flow of the case. Problems of rates need the responses to what they are the rates of.
/// Collective.
ResponseProblem problem_of(ResponseKey key, FlowCase& flow, const Responses& responses);

/// Solves for a group of variables about the present flow, from `guesses` where there are any; nothing when
/// it was stopped. Collective.
std::vector<Sensitivity> solve_group(SensitivitySolver& solver, std::span<const Variable> group,
                                     bool limiter_held, FlowCase& flow, const Responses& responses,
                                     const Responses* guesses = nullptr);

}  // namespace alphadot
