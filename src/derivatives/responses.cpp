#include "derivatives/responses.hpp"

#include <string>

#include "derivatives/block_solve.hpp"
#include "derivatives/controls.hpp"
#include "derivatives/flight_variables.hpp"

namespace alphadot {

std::optional<Variable> rate_of(Variable variable) {
  using enum Variable;
  switch (variable) {
    case alphadot:
      return alpha;
    case betadot:
      return beta;
    case alphaddot:
      return alphadot;
    case betaddot:
      return betadot;
    default:
      return is_control_rate(variable) ? std::optional(control_of_rate(variable)) : std::nullopt;
  }
}

ResponseProblem problem_of(ResponseKey key, FlowCase& flow, const Responses& responses) {
  const auto [variable, limiter_held] = key;
  ResponseProblem out{{std::string(name(variable)), change_of(variable, flow.settings().freestream)}};
  const bool has_rate =
      variable == Variable::alpha || variable == Variable::beta ||
      (flow.settings().derivatives.second_order && !is_control(variable) && rates_in(variable) == 1) ||
      (flow.settings().derivatives.control_rates && is_control(variable) && !is_control_rate(variable));
  if (has_rate) out.problem.further_orders = 1;
  if (const auto angle = rate_of(variable)) {
    const auto& response = responses.at({*angle, limiter_held});
    out.problem.rate = response.field;
    out.problem.rate_error = response.relative_error;
  }
  if (is_control(variable)) out.held = change_by_control(flow, variable, limiter_held);
  return out;
}

std::vector<Sensitivity> solve_group(SensitivitySolver& solver, std::span<const Variable> group,
                                     bool limiter_held, FlowCase& flow, const Responses& responses,
                                     const Responses* guesses) {
  std::vector<ResponseProblem> asked;
  std::vector<SensitivityProblem> problems;
  for (const auto variable : group) asked.push_back(problem_of({variable, limiter_held}, flow, responses));
  for (auto& [problem, held] : asked) {
    if (held) {
      problem.defect = held->residual;
      problem.own_loads = held->loads;
    }
    problems.push_back(problem);
  }
  for (std::size_t i = 0; guesses && i < group.size(); ++i) problems[i].guess = guesses->at({group[i]}).field;
  return solver.solve(problems);
}

std::vector<std::vector<Variable>> groups_of(const Case& settings) {
  using enum Variable;
  std::vector<std::vector<Variable>> out;
  if (settings.reference.half_model)
    out = {{alpha, q}, {alphadot}, {alphaddot}};
  else
    out = {{alpha, beta, q}, {p, r}, {alphadot, betadot}, {alphaddot, betaddot}};
  if (!settings.derivatives.second_order) out.pop_back();
  for (const auto& controls : {controls_of(settings), control_rates_of(settings)})
    for (std::size_t i = 0; i < controls.size(); ++i) {
      if (i % problems_at_a_time == 0) out.emplace_back();
      out.back().push_back(controls[i]);
    }
  return out;
}

std::vector<Variable> variables_of(const Case& settings) {
  std::vector<Variable> out;
  for (const auto& group : groups_of(settings)) out.insert(out.end(), group.begin(), group.end());
  for (const auto& sets : {control_sets_of(settings), control_set_rates_of(settings)})
    out.insert(out.end(), sets.begin(), sets.end());
  return out;
}

}  // namespace alphadot
