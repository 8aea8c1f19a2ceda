#include "app/linear_derivatives.hpp"

#include <atomic>
#include <cmath>
#include <string>
#include <utility>

#include "app/loads.hpp"
#include "app/responses.hpp"
#include "app/watchdog.hpp"
#include "core/log.hpp"
#include "derivatives/sensitivity.hpp"

namespace alphadot {

namespace {

/// Change of wind and grid motion per unit of a flight variable: rad for angles, rad per unit time for rates.
/// The body moves across the wind, which itself stays: with alpha the body sinks at V dalpha, normal to the
/// flight path.
ConditionsChange change_of(Variable variable, const FreestreamSettings& stream) {
  const Real a = stream.alpha * radians_per_degree, b = stream.beta * radians_per_degree;
  const Real speed = stream.mach;
  switch (variable) {
    case Variable::alpha:
      return {{}, -speed * std::cos(b) * Vec3{-std::sin(a), 0, std::cos(a)}, {}};
    case Variable::beta:
      return {{}, speed * Vec3{std::cos(a) * std::sin(b), std::cos(b), std::sin(a) * std::sin(b)}, {}};
    case Variable::p:
      return {{}, {}, {-1, 0, 0}};
    case Variable::q:
      return {{}, {}, {0, 1, 0}};
    case Variable::r:
      return {{}, {}, {0, 0, -1}};
    default:
      return {};
  }
}

/// The power of time in a variable's unit.
int time_derivatives(Variable variable) {
  using enum Variable;
  if (variable == alpha || variable == beta) return 0;
  return variable == alphaddot || variable == betaddot ? 2 : 1;
}

/// The problem of one variable. Those of the rates of the angles need the responses to the angles.
SensitivityProblem problem_of(ResponseKey key, const FlowCase& flow, const Responses& responses) {
  using enum Variable;
  const auto [variable, limiter_held] = key;
  SensitivityProblem out{std::string(name(variable)), change_of(variable, flow.settings().freestream), {}};
  if (variable == alphadot) out.rate = responses.at({alpha, limiter_held}).field;
  if (variable == betadot) out.rate = responses.at({beta, limiter_held}).field;
  if (variable == alphaddot) out.rate = responses.at({alphadot, limiter_held}).field;
  if (variable == betaddot) out.rate = responses.at({betadot, limiter_held}).field;
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

void add_column(DerivativeSet& derivatives, Variable variable, const Sensitivity& solution,
                const Case& settings) {
  const Real rate_scale =
      std::pow(2 * settings.freestream.mach / settings.reference.length, time_derivatives(variable));
  const auto values = coefficients(rate_scale * solution.total, settings);
  const auto errors = coefficients(rate_scale * solution.total_error, settings);
  CoefficientsOf<Estimate> column;
  for (int i = 0; i < Coefficients::size(); ++i) column[i] = {values[i], std::abs(errors[i])};
  derivatives[variable] = column;
  spdlog::info("{:9} {:3} iterations, linear residual {:.1e}", name(variable), solution.iterations,
               solution.relative_residual);
}

/// Solves for all variables but those that the checkpoint has, with a checkpoint after each group. The
/// uncertainty is that of the linear solves. Nothing when the run was stopped.
DerivativeSet solve_all(FlowCase& flow, SensitivitySolver& solver, Responses& responses, bool limiter_held) {
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
    for (const auto variable : group)
      add_column(out, variable, responses.at({variable, limiter_held}), flow.settings());
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
  EstimatedDerivatives out{solve_all(flow, solver, responses, false), {}};
  if (out.derivatives.empty()) return {};
  auto& linear = out.parts.emplace_back(UncertaintyPart{"linear", {}});
  for (const auto& [variable, column] : out.derivatives)
    for (int i = 0; i < column.size(); ++i) linear.share[variable][i] = column[i].uncertainty;
  if (!settings.derivatives.limiter_uncertainty) return out;

  const DerivativeSet held = solve_all(flow, solver, responses, true);
  if (held.empty()) return {};
  DerivativeSetOf<Real> share;
  for (const auto& [variable, column] : out.derivatives)
    for (int i = 0; i < column.size(); ++i)
      share[variable][i] = std::abs(held.at(variable)[i].value - column[i].value);
  out.add("limiter", std::move(share));
  return out;
}

void EstimatedDerivatives::add(std::string source, DerivativeSetOf<Real> share) {
  for (auto& [variable, column] : derivatives)
    for (int i = 0; i < column.size(); ++i) column[i].uncertainty += share.at(variable)[i];
  parts.push_back({std::move(source), std::move(share)});
}

}  // namespace alphadot
