// The verb "derivatives": the whole matrix of stability derivatives from linear solves about the steady
// state.
#include <fmt/format.h>

#include <atomic>
#include <cmath>
#include <vector>

#include "analysis/avl.hpp"
#include "analysis/axes.hpp"
#include "analysis/derivatives.hpp"
#include "analysis/jsbsim.hpp"
#include "analysis/moment_center.hpp"
#include "analysis/table.hpp"
#include "app/flow_case.hpp"
#include "app/loads.hpp"
#include "app/responses.hpp"
#include "app/stop.hpp"
#include "app/watchdog.hpp"
#include "core/error.hpp"
#include "core/log.hpp"
#include "core/timer.hpp"
#include "io/case_words.hpp"
#include "io/files.hpp"
#include "solver/sensitivity.hpp"

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

/// Derivatives, and the parts that their uncertainties are the sums of.
struct Estimated {
  DerivativeSet derivatives;
  std::vector<UncertaintyPart> parts;
};

/// No derivatives when the run was stopped.
Estimated estimate_all(FlowCase& flow) {
  const Case& settings = flow.settings();
  Responses responses(flow);
  std::atomic<GlobalIndex> linear_iterations{0};
  const Watchdog watchdog(
      settings.checkpoint.watchdog_minutes, [&] { return linear_iterations.load(); }, flow.communicator());
  const auto go_on = [&] {
    ++linear_iterations;
    return !flow.checkpoints().wish(false).stop;
  };
  SensitivitySolver solver(flow.iteration(), flow.conditions(), settings.derivatives, go_on);
  Estimated out{solve_all(flow, solver, responses, false), {}};
  if (out.derivatives.empty()) return {};
  auto& linear = out.parts.emplace_back("linear");
  for (const auto& [variable, column] : out.derivatives)
    for (int i = 0; i < column.size(); ++i) linear.share[variable][i] = column[i].uncertainty;
  if (!settings.derivatives.limiter_uncertainty) return out;

  const DerivativeSet held = solve_all(flow, solver, responses, true);
  if (held.empty()) return {};
  auto& limiter = out.parts.emplace_back("limiter");
  for (auto& [variable, column] : out.derivatives)
    for (int i = 0; i < column.size(); ++i) {
      const Real share = std::abs(held.at(variable)[i].value - column[i].value);
      limiter.share[variable][i] = share;
      column[i].uncertainty += share;
    }
  return out;
}

/// Derivatives are about a steady state, which a checkpoint made in a motion no longer has.
void check_restart(const FlowCase& flow) {
  const auto* restart = flow.checkpoints().restart();
  if (restart && restart->phase == "motion")
    throw InputError(
        flow.folder(), 0, "the checkpoint to go on from was made in a motion",
        "name that of the steady state with --restart FILE, or begin in another folder with --out DIR");
}

/// The same numbers for people, spreadsheets, AVL's readers and JSBSim.
void write_tables(const FlowCase& flow, const DerivativeSet& derivatives, const std::vector<TableRow>& rows) {
  const Case& settings = flow.settings();
  const FlightPoint point{settings.title, settings.reference, settings.freestream,
                          coefficients(flow.steady_report().total, settings), derivatives};
  const std::string stem = flow.folder() + "/derivatives";
  replace_file_with(stem + ".csv", derivative_csv(rows, settings.reference));
  const auto stability =
      to_stability_axes(derivatives, point.steady, settings.freestream.alpha * radians_per_degree);
  replace_file_with(stem + ".stability_axes.csv",
                    derivative_csv(rows_of(stability, rows.front().method, Axes::stability),
                                   settings.reference, Axes::stability));
  replace_file_with(stem + ".st", avl_stability_text(point));
  replace_file_with(stem + ".jsbsim.xml", jsbsim_aerodynamics(point));
}

/// Where the configuration balances, about the moment centre, and up to which reduced frequency its
/// derivatives describe a plunge to 1 %.
NamedValues longitudinal_of(const Case& settings, const DerivativeSet& derivatives) {
  const auto& alpha = derivatives.at(Variable::alpha);
  const auto margin = static_margin(alpha.CN, alpha.Cm);
  const Real length = settings.reference.length;
  NamedValues out{{"static_margin", margin.value},
                  {"static_margin_uncertainty", margin.uncertainty},
                  {"neutral_point_x", settings.reference.moment_center.x + margin.value * length},
                  {"neutral_point_uncertainty", margin.uncertainty * length}};
  if (const auto second = derivatives.find(Variable::alphaddot); second != derivatives.end()) {
    constexpr Real share = 0.01;
    out.emplace_back("quasi_steady_k_of_CN",
                     quasi_steady_limit(alpha.CN.value, second->second.CN.value, share));
    out.emplace_back("quasi_steady_k_of_Cm",
                     quasi_steady_limit(alpha.Cm.value, second->second.Cm.value, share));
  }
  return out;
}

void print(const NamedValues& longitudinal) {
  if (!spdlog::should_log(spdlog::level::info)) return;
  for (const auto& [name, value] : longitudinal) fmt::print("{:<26} {:.5g}\n", name, value);
}

}  // namespace

RunStatus derivatives_verb(const CaseArguments& arguments, const Communicator& comm) {
  const SignalListener signals;
  FlowCase flow(arguments, comm);
  check_restart(flow);
  flow.announce();
  Estimated estimated;
  RunStatus status = RunStatus::error;
  Real linear_cpu = not_measured;
  try {
    status = flow.march();
    const Timer timer;
    if (status != RunStatus::interrupted) {
      flow.progress().begin_linear_solves();
      estimated = estimate_all(flow);
    }
    if (status != RunStatus::interrupted && estimated.derivatives.empty()) {
      status = RunStatus::interrupted;
      flow.set_message(flow.checkpoints().stop_reason());
    }
    linear_cpu = timer.cpu();
  } catch (const DivergedError& error) {
    status = RunStatus::diverged;
    flow.report_divergence(error);
  }

  const auto& [derivatives, parts] = estimated;
  const auto rows = rows_of(
      derivatives, fmt::format("linear solve, k -> 0, {}", word_of(flow.settings().derivatives.method)),
      Axes::body, parts);
  Result result = flow.result(status, rows);
  result.performance.linear_cpu_s = comm.sum(linear_cpu);
  if (!rows.empty()) result.longitudinal = longitudinal_of(flow.settings(), derivatives);
  if (!rows.empty()) comm.on_root([&] { write_tables(flow, estimated.derivatives, rows); });
  flow.write(result);
  flow.print(result, rows);
  print(result.longitudinal);
  spdlog::info("of these, steady state {:.1f} s of processor, linear solves {:.1f} s",
               result.performance.steady_cpu_s, result.performance.linear_cpu_s);
  return status;
}

}  // namespace alphadot
