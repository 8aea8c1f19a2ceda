#include "derivatives/linear_derivatives.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>

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
SensitivityProblem problem_of(ResponseKey key, const FlowCase& flow, const Responses& responses) {
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

/// Solves for all variables but those that have been solved for, and says of each how that went. The
/// uncertainty is that of the linear solves. Nothing when the observer ended it.
DerivativeSet solve_all(const FlowCase& flow, SensitivitySolver& solver, Responses& responses,
                        bool limiter_held, const SolveObserver& observer, LinearDerivatives& out) {
  if (limiter_held) {
    spdlog::info("once more with the limiter's factors held");
    solver.hold_limiter();
  }
  DerivativeSet derivatives;
  auto& unconverged = out.estimated.unconverged;
  for (const auto& group : groups_of(flow.settings())) {
    if (!responses.contains({group.front(), limiter_held})) {
      std::vector<SensitivityProblem> problems;
      for (const auto variable : group)
        problems.push_back(problem_of({variable, limiter_held}, flow, responses));
      auto solved = solver.solve(problems);
      if (solved.empty()) return {};
      for (std::size_t i = 0; i < group.size(); ++i)
        responses[{group[i], limiter_held}] = std::move(solved[i]);
      if (observer.solved) observer.solved();
    }
    for (const auto variable : group) {
      const auto& solution = responses.at({variable, limiter_held});
      derivatives[variable] = column_of(variable, solution, flow.settings());
      spdlog::info("{:9} {:3} iterations, linear residual {:.1e}", name(variable), solution.iterations,
                   solution.relative_residual);
      auto shortfall = shortfall_of_solve(name(variable), solution.relative_residual, solution.iterations,
                                          flow.settings().derivatives.orders);
      if (const auto angle = rate_of(variable); !shortfall.empty() || (angle && unconverged.contains(*angle)))
        unconverged.insert(variable);
      if (!shortfall.empty()) out.shortfalls.push_back(std::move(shortfall));
    }
  }
  return derivatives;
}

/// For what a step of Newton's method leaves to the next, also of a component that it happens not to move:
/// shown to hold from one decade on.
constexpr Real step_safety = 2, of_other_components = 0.3;
/// Decades by which a derivative may be worse converged than the flow that it is about.
constexpr Real lost_decades = 3;

/// What is large beside a column of derivatives. Forces and moments count alike with an arm between them that
/// is the body's size, `arm` reference lengths, so that no choice of these matters.
Coefficients largest_of(const Coefficients& column, Real arm) {
  const Coefficients unit{1, 1, 1, arm, arm, arm};
  Real largest = 0;
  for (int i = 0; i < column.size(); ++i) largest = std::max(largest, std::abs(column[i]) / unit[i]);
  return largest * unit;
}

/// Bound of what a deeply converged steady residual still does: a share of what is large in each variable.
DerivativeSetOf<Real> small_steady_part(const DerivativeSet& derivatives, Real orders, Real arm) {
  DerivativeSetOf<Real> out;
  for (const auto& [variable, column] : derivatives) {
    Coefficients values;
    for (int i = 0; i < column.size(); ++i) values[i] = column[i].value;
    out[variable] = std::pow(10.0, lost_decades - orders) * largest_of(values, arm);
  }
  return out;
}

/// How much the derivatives change when the steady flow becomes one step of Newton's method better. Nothing
/// when the run was stopped.
DerivativeSetOf<Real> steady_part(FlowCase& flow, SensitivitySolver& solver, const Responses& responses,
                                  const DerivativeSet& derivatives, Real arm,
                                  const std::function<bool()>& go_on) {
  const NewtonStep step(flow.iteration(), flow.conditions(), solver);
  if (step.was_stopped()) return {};
  auto settings = flow.settings().derivatives;
  settings.orders = 1;  // of a small difference
  SensitivitySolver better(flow.iteration(), flow.conditions(), settings, go_on);
  Responses solved;
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
      Coefficients change;
      for (int k = 0; k < column.size(); ++k)
        change[k] = std::abs(column[k].value - derivatives.at(group[i])[k].value);
      const auto largest = largest_of(change, arm);
      for (int k = 0; k < column.size(); ++k)
        out[group[i]][k] = step_safety * (change[k] + of_other_components * largest[k]);
      solved[{group[i]}] = std::move(changed[i]);
    }
  }
  return out;
}

}  // namespace

std::string shortfall_of_solve(std::string_view what, Real relative_residual, int iterations, Real orders) {
  if (relative_residual <= std::pow(10.0, -orders)) return {};
  return fmt::format("the linear residual for {} dropped {:.1f} of {:g} decades in {} iterations", what,
                     -std::log10(relative_residual), orders, iterations);
}

LinearDerivatives linear_derivatives(FlowCase& flow, Responses& responses, const SolveObserver& observer) {
  const auto& settings = flow.settings().derivatives;
  SensitivitySolver solver(flow.iteration(), flow.conditions(), settings, observer.go_on);
  LinearDerivatives out;
  EstimatedDerivatives& estimated = out.estimated;
  const auto ended = [&] { return LinearDerivatives{{}, std::move(out.shortfalls)}; };
  estimated.derivatives = solve_all(flow, solver, responses, false, observer, out);
  if (estimated.derivatives.empty()) return ended();
  auto& linear = estimated.parts.emplace_back(UncertaintyPart{"linear", {}});
  for (const auto& [variable, column] : estimated.derivatives)
    for (int i = 0; i < column.size(); ++i) linear.half_width[variable][i] = column[i].uncertainty;
  const Real arm = solver.body_size() / flow.settings().reference.length;
  if (flow.steady_orders() < deep_steady_orders) {
    spdlog::info("once more about a flow one step of Newton's method nearer to the steady one");
    auto half_width = steady_part(flow, solver, responses, estimated.derivatives, arm, observer.go_on);
    if (half_width.empty()) return ended();
    estimated.add("steady", std::move(half_width));
  } else {
    estimated.add("steady", small_steady_part(estimated.derivatives, flow.steady_orders(), arm));
  }
  if (!settings.limiter_uncertainty) return out;

  const DerivativeSet held = solve_all(flow, solver, responses, true, observer, out);
  if (held.empty()) return ended();
  DerivativeSetOf<Real> half_width;
  for (const auto& [variable, column] : estimated.derivatives)
    for (int i = 0; i < column.size(); ++i)
      half_width[variable][i] = std::abs(held.at(variable)[i].value - column[i].value);
  estimated.add("limiter", std::move(half_width));
  return out;
}

}  // namespace alphadot
