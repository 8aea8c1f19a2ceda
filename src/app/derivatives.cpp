// The verb "derivatives": the whole matrix of stability derivatives from linear solves about the steady
// state.
#include <fmt/format.h>

#include <memory>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "analysis/avl.hpp"
#include "analysis/axes.hpp"
#include "analysis/jsbsim.hpp"
#include "analysis/static_margin.hpp"
#include "analysis/table.hpp"
#include "app/coarser_meshes.hpp"
#include "app/flow_case.hpp"
#include "app/linear_derivatives.hpp"
#include "app/steady_restart.hpp"
#include "app/stop.hpp"
#include "core/error.hpp"
#include "core/log.hpp"
#include "core/timer.hpp"
#include "derivatives/loads.hpp"
#include "io/case_words.hpp"
#include "io/files.hpp"

namespace alphadot {

namespace {

/// Stability axes mix rolling and yawing.
std::set<Variable> on_stability_axes(std::set<Variable> unconverged) {
  for (const auto& [one, other] : {std::pair{Variable::p, Variable::r}, std::pair{Variable::r, Variable::p}})
    if (unconverged.contains(one)) unconverged.insert(other);
  return unconverged;
}

/// The same numbers for spreadsheets, AVL's readers and JSBSim.
void write_tables(const FlowCase& flow, RunStatus end, const EstimatedDerivatives& estimated,
                  const std::vector<TableRow>& rows) {
  const Case& settings = flow.settings();
  const auto& derivatives = estimated.derivatives;
  const auto head = flow.table_head(end, rows);
  const FlightPoint point{settings.title,      settings.reference,
                          settings.freestream, coefficients(flow.steady_report().total, settings),
                          derivatives,         head.origin,
                          head.status};
  const std::string stem = flow.folder() + "/derivatives";
  replace_file_with(stem + ".csv", derivative_csv(rows, head));
  const auto stability =
      to_stability_axes(derivatives, point.steady, settings.freestream.alpha * radians_per_degree);
  replace_file_with(stem + ".stability_axes.csv",
                    derivative_csv(rows_of(stability, rows.front().method, Axes::stability, {},
                                           on_stability_axes(estimated.unconverged)),
                                   head, Axes::stability));
  replace_file_with(stem + ".st", avl_stability_text(point));
  replace_file_with(stem + ".jsbsim.xml", jsbsim_aerodynamics(point));
}

/// Where the configuration balances: static margin in reference lengths and neutral point. Each part of the
/// uncertainty is that of the derivatives' same part.
std::vector<TableRow> balance_rows(const Case& settings, const EstimatedDerivatives& estimated) {
  const auto& alpha = estimated.derivatives.at(Variable::alpha);
  TableRow margin{"static_margin", static_margin(alpha.CN, alpha.Cm), "-Cm_alpha / CN_alpha, in lengths"};
  for (const auto& [source, share] : estimated.parts) {
    const auto& of_alpha = share.at(Variable::alpha);
    const auto part = static_margin({alpha.CN.value, of_alpha.CN}, {alpha.Cm.value, of_alpha.Cm}).uncertainty;
    margin.parts.emplace_back(source, part);
  }
  const Real length = settings.reference.length;
  TableRow point{"neutral_point_x", length * margin.value, "centre + margin, in units of the mesh",
                 margin.parts};
  point.value.value += settings.reference.moment_center.x;
  for (auto& [source, part] : point.parts) part *= length;
  margin.converged = point.converged = !estimated.unconverged.contains(Variable::alpha);
  return {margin, point};
}

/// The balance, and up to which reduced frequency the derivatives describe a plunge to 1 %.
NamedValues longitudinal_of(std::span<const TableRow> balance, const DerivativeSet& derivatives) {
  NamedValues out{{"static_margin", balance[0].value.value},
                  {"static_margin_uncertainty", balance[0].value.uncertainty},
                  {"neutral_point_x", balance[1].value.value},
                  {"neutral_point_uncertainty", balance[1].value.uncertainty}};
  const auto& alpha = derivatives.at(Variable::alpha);
  if (const auto second = derivatives.find(Variable::alphaddot); second != derivatives.end()) {
    constexpr Real share = 0.01;
    out.emplace_back("quasi_steady_k_of_CN",
                     quasi_steady_limit(alpha.CN.value, second->second.CN.value, share));
    out.emplace_back("quasi_steady_k_of_Cm",
                     quasi_steady_limit(alpha.Cm.value, second->second.Cm.value, share));
  }
  return out;
}

/// The limits of quasi-steady flight, which are no rows of a table.
void print_limits(const NamedValues& longitudinal) {
  if (!spdlog::should_log(spdlog::level::info)) return;
  for (const auto& [name, value] : longitudinal)
    if (name.starts_with("quasi_steady")) print_out(fmt::format("{} {:.5g}\n", name, value));
}

/// What refinement says about the derivatives that a result has.
void add(const DerivativeSetOf<MeshConvergence>& convergence, Result& result) {
  for (const auto& [variable, column] : convergence)
    for (int i = 0; i < column.size(); ++i) {
      const auto found =
          result.derivatives.find(derivative_name(coefficient_names[static_cast<std::size_t>(i)], variable));
      if (found == result.derivatives.end()) continue;
      const MeshConvergence& entry = column[i];
      found->second.mesh_convergence = {{"extrapolated", entry.extrapolated},
                                        {"observed_order", entry.observed ? entry.order : not_measured}};
    }
}

/// What came of a case: no derivatives when it was stopped or diverged.
struct Outcome {
  Result result;
  DerivativeSet derivatives;
  std::vector<TableRow> rows;
};

/// Marches to the steady state, solves for the derivatives and writes their tables.
Outcome complete(FlowCase& flow, std::span<const MeshDerivatives> coarser) {
  EstimatedDerivatives estimated;
  DerivativeSetOf<MeshConvergence> convergence;
  RunStatus status = RunStatus::error;
  Real linear_cpu = not_measured;
  bool foundation_holds = false;  // of all derivatives: the steady flow and the coarser meshes
  try {
    status = flow.march();
    foundation_holds = flow.shortfalls().empty();
    const Timer timer;
    if (status != RunStatus::interrupted) {
      flow.progress().begin_phase("linear solves");
      estimated = linear_derivatives(flow);
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
  if (!foundation_holds)
    for (const auto& [variable, column] : estimated.derivatives) estimated.unconverged.insert(variable);
  if (!estimated.derivatives.empty() && !coarser.empty())
    convergence = add_mesh_part(estimated, flow, coarser);

  auto rows = rows_of(estimated.derivatives,
                      fmt::format("linear solve, k -> 0, {}", word_of(flow.settings().derivatives.method)),
                      Axes::body, estimated.parts, estimated.unconverged);
  Result result = flow.result(status, rows);
  add(convergence, result);
  result.performance.linear_cpu_s = flow.communicator().sum(linear_cpu);
  if (!rows.empty()) {
    const auto balance = balance_rows(flow.settings(), estimated);
    result.longitudinal = longitudinal_of(balance, estimated.derivatives);
    rows.insert(rows.end(), balance.begin(), balance.end());
    flow.communicator().on_root([&] { write_tables(flow, status, estimated, rows); });
  }
  return {std::move(result), std::move(estimated.derivatives), std::move(rows)};
}

void say_which(std::size_t number, std::size_t of, const FlowCase& flow) {
  if (of > 1)
    spdlog::info("mesh {} of {}: {}, {} cells, in {}", number, of, flow.setup().mesh.file,
                 flow.setup().mesh.cells, flow.folder());
}

/// Completes the cases on coarser meshes one after the other and lets go of them. Nothing when one was
/// stopped or diverged: the result of the finest then says so.
std::optional<std::vector<MeshDerivatives>> complete_coarser(FlowCase& finest,
                                                             std::vector<std::unique_ptr<FlowCase>> levels,
                                                             RunStatus& status) {
  std::vector<MeshDerivatives> out;
  for (std::size_t i = 0; i < levels.size(); ++i) {
    const auto level = std::move(levels[i]);
    level->announce();
    say_which(i + 2, levels.size() + 1, *level);
    finest.progress().begin_phase(fmt::format("mesh {} of {}", i + 2, levels.size() + 1));
    auto [result, derivatives, rows] = complete(*level, {});
    level->write(result);
    if (derivatives.empty()) {
      status = result.status;
      const std::string message = fmt::format("on {}: {}", level->setup().mesh.file, result.message);
      finest.announce(status, message);
      spdlog::info("{} {}", to_string(status), message);
      return std::nullopt;
    }
    if (result.status == RunStatus::unconverged)
      finest.fall_short(fmt::format("on {}: {}", level->setup().mesh.file, result.message));
    out.push_back({spacing_of(level->setup(), level->communicator()), std::move(derivatives)});
  }
  return out;
}

}  // namespace

RunStatus derivatives_verb(const CaseArguments& arguments, const Communicator& comm) {
  const SignalListener signals;
  FlowCase flow(load_case(arguments.case_file, arguments.overrides, comm), arguments, "derivatives", comm);
  check_steady_restart(flow);
  auto levels = coarser_cases(arguments, flow);
  for (const auto& level : levels) check_steady_restart(*level);
  flow.announce();
  const std::size_t meshes = levels.size() + 1;

  const Timer timer;
  RunStatus status = RunStatus::completed;
  const auto coarser = complete_coarser(flow, std::move(levels), status);
  if (!coarser) return status;
  const Real coarser_cpu = comm.sum(timer.cpu());

  say_which(1, meshes, flow);
  auto [result, derivatives, rows] = complete(flow, *coarser);
  auto& performance = result.performance;
  if (meshes > 1) {
    performance.coarser_meshes_cpu_s = coarser_cpu;
    performance.core_us_per_cell_iteration *= 1 - coarser_cpu / performance.cpu_s;
  }
  flow.write(result);
  flow.print(result, rows);
  print_limits(result.longitudinal);
  spdlog::info("of these, steady state {:.1f} s of processor, linear solves {:.1f} s{}",
               performance.steady_cpu_s, performance.linear_cpu_s,
               meshes > 1 ? fmt::format(", coarser meshes {:.1f} s", coarser_cpu) : "");
  flow.print_end(result);
  return result.status;
}

}  // namespace alphadot
