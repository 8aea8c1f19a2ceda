#include "app/linear_derivatives.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include "app/responses.hpp"
#include "app/watchdog.hpp"
#include "core/log.hpp"
#include "derivatives/flight_variables.hpp"
#include "derivatives/loads.hpp"
#include "derivatives/sensitivity.hpp"
#include "derivatives/steady_error.hpp"

namespace alphadot {

namespace {

/// What a variable is the rate of.
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
      return std::nullopt;
  }
}

/// The problem of one variable. Those of the rates of the angles need the responses to the angles.
template <class Solved>
SensitivityProblem problem_of(ResponseKey key, const FlowCase& flow, const Solved& responses) {
  const auto [variable, limiter_held] = key;
  SensitivityProblem out{std::string(name(variable)), change_of(variable, flow.settings().freestream)};
  const bool has_rate = variable == Variable::alpha || variable == Variable::beta ||
                        (flow.settings().derivatives.second_order && rates_in(variable) == 1);
  if (has_rate) out.further_orders = 1;
  if (const auto angle = rate_of(variable)) {
    const auto& response = responses.at({*angle, limiter_held});
    out.rate = response.field;
    out.rate_error = response.relative_error;
  }
  return out;
}

/// Variables that are solved for together, in this order: angles and rotations, then the rates of the angles,
/// then their rates.
std::vector<std::vector<Variable>> groups_of(const Case& settings) {
  using enum Variable;
  std::vector<std::vector<Variable>> out;
  if (settings.reference.half_model)
    out = {{alpha, q}, {alphadot}, {alphaddot}};
  else
    out = {{alpha, beta, q}, {p, r}, {alphadot, betadot}, {alphaddot, betaddot}};
  if (!settings.derivatives.second_order) out.pop_back();
  return out;
}

CoefficientsOf<Estimate> column_of(Variable variable, const Sensitivity& solution, const Case& settings) {
  const Real scale = rate_scale(variable, settings);
  const auto values = coefficients(scale * solution.total, settings);
  const auto errors = coefficients(scale * solution.total_error, settings);
  CoefficientsOf<Estimate> out;
  for (int i = 0; i < Coefficients::size(); ++i) out[i] = {values[i], std::abs(errors[i])};
  return out;
}

/// Solves for all variables but those that the checkpoint has, with a checkpoint after each group; adds those
/// that fell short to `unconverged`. The uncertainty is that of the linear solves. Nothing when the run was
/// stopped.
DerivativeSet solve_all(FlowCase& flow, SensitivitySolver& solver, Responses& responses, bool limiter_held,
                        std::set<Variable>& unconverged) {
  if (limiter_held) {
    spdlog::info("once more with the limiter's factors held");
    solver.hold_limiter();
  }
  DerivativeSet out;
  for (const auto& group : groups_of(flow.settings())) {
    if (!responses.has({group.front(), limiter_held})) {
      std::vector<SensitivityProblem> problems;
      for (const auto variable : group)
        problems.push_back(problem_of({variable, limiter_held}, flow, responses));
      auto solved = solver.solve(problems);
      if (solved.empty()) return {};
      for (std::size_t i = 0; i < group.size(); ++i)
        responses.add({group[i], limiter_held}, std::move(solved[i]));
      responses.save();
    }
    for (const auto variable : group) {
      const auto& solution = responses.at({variable, limiter_held});
      out[variable] = column_of(variable, solution, flow.settings());
      spdlog::info("{:9} {:3} iterations, linear residual {:.1e}", name(variable), solution.iterations,
                   solution.relative_residual);
      const auto angle = rate_of(variable);
      if (!flow.reached(name(variable), solution.relative_residual, solution.iterations) ||
          (angle && unconverged.contains(*angle)))
        unconverged.insert(variable);
    }
  }
  return out;
}

/// For what a step of Newton's method leaves to the next, also of a component that it happens not to move:
/// shown to hold from one decade on.
constexpr Real step_safety = 2, of_other_components = 0.3;
/// Decades by which a derivative may be worse converged than the flow that it is about.
constexpr Real lost_decades = 3;

/// Bound of what a deeply converged steady residual still does: a share of each variable's largest entry.
DerivativeSetOf<Real> small_steady_part(const DerivativeSet& derivatives, Real orders) {
  DerivativeSetOf<Real> out;
  for (const auto& [variable, column] : derivatives) {
    Real largest = 0;
    for (int i = 0; i < column.size(); ++i) largest = std::max(largest, std::abs(column[i].value));
    for (int i = 0; i < column.size(); ++i)
      out[variable][i] = std::pow(10.0, lost_decades - orders) * largest;
  }
  return out;
}

/// How much the derivatives change when the steady flow becomes one step of Newton's method better. Nothing
/// when the run was stopped.
DerivativeSetOf<Real> steady_part(FlowCase& flow, SensitivitySolver& solver, const Responses& responses,
                                  const DerivativeSet& derivatives, const std::function<bool()>& go_on) {
  const NewtonStep step(flow.iteration(), flow.conditions(), solver);
  if (step.was_stopped()) return {};
  auto settings = flow.settings().derivatives;
  settings.orders = 1;  // of a small difference
  SensitivitySolver better(flow.iteration(), flow.conditions(), settings, go_on);
  std::map<ResponseKey, Sensitivity> solved;
  DerivativeSetOf<Real> out;
  for (const auto& group : groups_of(flow.settings())) {
    std::vector<SensitivityProblem> problems;
    for (const auto variable : group) {
      problems.push_back(problem_of({variable}, flow, solved));
      problems.back().guess = responses.at({variable}).field;
    }
    auto changed = better.solve(problems);
    if (changed.empty()) return {};
    for (std::size_t i = 0; i < group.size(); ++i) {
      const auto column = column_of(group[i], changed[i], flow.settings());
      CoefficientsOf<Real> change;
      Real largest = 0;
      for (int k = 0; k < column.size(); ++k) {
        change[k] = std::abs(column[k].value - derivatives.at(group[i])[k].value);
        largest = std::max(largest, change[k]);
      }
      for (int k = 0; k < column.size(); ++k)
        out[group[i]][k] = step_safety * (change[k] + of_other_components * largest);
      solved[{group[i]}] = std::move(changed[i]);
    }
  }
  return out;
}

}  // namespace

EstimatedDerivatives linear_derivatives(FlowCase& flow) {
  const Case& settings = flow.settings();
  Responses responses(flow);
  std::atomic<GlobalIndex> linear_iterations{0};
  const Watchdog watchdog(
      settings.checkpoint.watchdog_minutes, [&] { return linear_iterations.load(); }, flow.communicator());
  const auto go_on = [&] {
    ++linear_iterations;
    return !flow.checkpoints().request(false).stop;
  };
  SensitivitySolver solver(flow.iteration(), flow.conditions(), settings.derivatives, go_on);
  EstimatedDerivatives out;
  out.derivatives = solve_all(flow, solver, responses, false, out.unconverged);
  if (out.derivatives.empty()) return {};
  auto& linear = out.parts.emplace_back(UncertaintyPart{"linear", {}});
  for (const auto& [variable, column] : out.derivatives)
    for (int i = 0; i < column.size(); ++i) linear.share[variable][i] = column[i].uncertainty;
  if (flow.steady_orders() < deep_steady_orders) {
    spdlog::info("once more about a flow one step of Newton's method nearer to the steady one");
    auto share = steady_part(flow, solver, responses, out.derivatives, go_on);
    if (share.empty()) return {};
    out.add("steady", std::move(share));
  } else {
    out.add("steady", small_steady_part(out.derivatives, flow.steady_orders()));
  }
  if (!settings.derivatives.limiter_uncertainty) return out;

  const DerivativeSet held = solve_all(flow, solver, responses, true, out.unconverged);
  if (held.empty()) return {};
  DerivativeSetOf<Real> share;
  for (const auto& [variable, column] : out.derivatives)
    for (int i = 0; i < column.size(); ++i)
      share[variable][i] = std::abs(held.at(variable)[i].value - column[i].value);
  out.add("limiter", std::move(share));
  return out;
}

}  // namespace alphadot
