// The verb "derivatives": the whole matrix of stability derivatives from linear solves about the steady
// state.
#include <fmt/format.h>

#include <cmath>
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
#include "analysis/table.hpp"
#include "app/case_run.hpp"
#include "app/coarser_meshes.hpp"
#include "app/kept_solutions.hpp"
#include "app/load_case.hpp"
#include "app/stop.hpp"
#include "core/log.hpp"
#include "core/timer.hpp"
#include "derivatives/balance.hpp"
#include "derivatives/component_table.hpp"
#include "derivatives/loads.hpp"
#include "derivatives/panel_table.hpp"
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
void write_tables(const CaseRun& run, const Result& result, const LinearDerivatives& solved,
                  const std::vector<TableRow>& rows) {
  const Case& settings = run.settings();
  const auto& estimated = solved.estimated;
  const auto& derivatives = estimated.derivatives;
  const auto head = run.record().table_head(result.status, rows);
  const FlightPoint point{settings.title,      settings.reference,
                          settings.freestream, coefficients(run.flow().steady_report().total, settings),
                          derivatives,         head.origin,
                          head.status};
  const std::string stem = run.record().folder() + "/derivatives";
  replace_file_with(stem + ".csv", derivative_csv(rows, head));
  const auto stability =
      to_stability_axes(derivatives, point.steady, settings.freestream.alpha * radians_per_degree);
  replace_file_with(stem + ".stability_axes.csv",
                    derivative_csv(rows_of(stability, rows.front().method, Axes::stability, {},
                                           on_stability_axes(estimated.unconverged)),
                                   head, Axes::stability));
  replace_file_with(stem + ".st", avl_stability_text(point));
  replace_file_with(stem + ".jsbsim.xml", jsbsim_aerodynamics(point));
  auto of_components = head;
  of_components.uncertainty = solver_only;
  const std::string& folder = run.record().folder();
  replace_file_with(folder + "/components.csv", component_csv(solved.components, of_components));
  if (!settings.controls.empty())
    replace_file_with(folder + "/panels.csv", panel_csv(solved.panels, result.panels, of_components));
  if (!solved.along_body.empty())
    replace_file_with(
        folder + "/along_body.csv",
        distribution_csv(solved.along_body, "x", "Moments about the moment centre", of_components));
  if (!solved.along_panels.empty())
    replace_file_with(folder + "/along_panels.csv",
                      distribution_csv(solved.along_panels, "s",
                                       "Of each panel by itself: " + std::string(panel_note), of_components));
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
  FieldsOnFaces pressures;
};

/// Marches to the steady state, solves for the derivatives and writes their tables.
Outcome complete(CaseRun& run, std::span<const MeshDerivatives> coarser) {
  auto& record = run.record();
  LinearDerivatives solved;
  auto& estimated = solved.estimated;
  Real linear_cpu = not_measured;
  bool foundation_holds = false;  // of all derivatives: the steady flow and the coarser meshes
  const RunStatus status = run.carry_out([&](RunStatus marched) {
    foundation_holds = record.shortfalls().empty();
    const Timer timer;
    run.progress().begin_phase("linear solves");
    Responses responses = kept_responses(run);
    const LinearSolves solves(run, [&] { keep(run, responses); });
    solved = linear_derivatives(run.flow(), responses, solves.observer());
    for (auto& shortfall : solved.shortfalls) record.fall_short(std::move(shortfall));
    linear_cpu = timer.cpu();
    return estimated.derivatives.empty() ? RunStatus::interrupted : marched;
  });
  if (!foundation_holds)
    for (const auto& [variable, column] : estimated.derivatives) estimated.unconverged.insert(variable);
  for (auto& component : solved.components)
    component.estimated.unconverged = component.one_side.unconverged = estimated.unconverged;
  for (auto& panel : solved.panels) panel.estimated.unconverged = estimated.unconverged;
  DerivativeSetOf<MeshConvergence> convergence;
  if (!estimated.derivatives.empty() && !coarser.empty())
    convergence = add_mesh_part(estimated, run.flow(), coarser);

  const Case& settings = run.settings();
  auto rows = rows_of(estimated.derivatives,
                      fmt::format("linear solve, k -> 0, {}", word_of(settings.derivatives.method)),
                      Axes::body, estimated.parts, estimated.unconverged);
  Result result = record.result(status, rows);
  add(convergence, result);
  result.performance.linear_cpu_s = run.communicator().sum(linear_cpu);
  if (!rows.empty()) {
    const auto balance = balance_rows(settings, estimated);
    result.longitudinal = longitudinal_of(balance, estimated.derivatives);
    rows.insert(rows.end(), balance.begin(), balance.end());
    run.communicator().on_root([&] { write_tables(run, result, solved, rows); });
  }
  return {std::move(result), std::move(estimated.derivatives), std::move(rows), std::move(solved.pressures)};
}

void say_which(std::size_t number, std::size_t of, const CaseRun& run) {
  const auto& mesh = run.flow().setup().mesh;
  if (of > 1)
    spdlog::info("mesh {} of {}: {}, {} cells, in {}", number, of, mesh.file, mesh.cells,
                 run.record().folder());
}

/// Completes the cases on coarser meshes one after the other and lets go of them. Nothing when one was
/// stopped or diverged: the result of the finest then says so.
std::optional<std::vector<MeshDerivatives>> complete_coarser(CaseRun& finest,
                                                             std::vector<std::unique_ptr<CaseRun>> levels,
                                                             RunStatus& status) {
  std::vector<MeshDerivatives> out;
  for (std::size_t i = 0; i < levels.size(); ++i) {
    const auto level = std::move(levels[i]);
    const Setup& setup = level->flow().setup();
    level->record().announce();
    say_which(i + 2, levels.size() + 1, *level);
    finest.progress().begin_phase(fmt::format("mesh {} of {}", i + 2, levels.size() + 1));
    auto [result, derivatives, rows, pressures] = complete(*level, {});
    level->record().write(result, pressures);
    const std::string message = fmt::format("on {}: {}", setup.mesh.file, result.message);
    if (derivatives.empty()) {
      status = result.status;
      finest.record().announce(status, message);
      spdlog::info("{} {}", to_string(status), message);
      return std::nullopt;
    }
    if (result.status == RunStatus::unconverged) finest.record().fall_short(message);
    out.push_back({spacing_of(setup, level->communicator()), std::move(derivatives)});
  }
  return out;
}

}  // namespace

RunStatus derivatives_verb(const CaseArguments& arguments, const Communicator& comm) {
  const SignalListener signals;
  CaseRun run(load_case(arguments.case_file, arguments.overrides, comm), arguments, "derivatives", comm);
  run.check_not_in_motion();
  auto levels = coarser_runs(arguments, run);
  for (const auto& level : levels) level->check_not_in_motion();
  auto& record = run.record();
  record.announce();
  const std::size_t meshes = levels.size() + 1;

  const Timer timer;
  RunStatus status = RunStatus::completed;
  const auto coarser = complete_coarser(run, std::move(levels), status);
  if (!coarser) return status;
  const Real coarser_cpu = comm.sum(timer.cpu());

  say_which(1, meshes, run);
  auto [result, derivatives, rows, pressures] = complete(run, *coarser);
  auto& performance = result.performance;
  if (meshes > 1) {
    performance.coarser_meshes_cpu_s = coarser_cpu;
    performance.core_us_per_cell_iteration *= 1 - coarser_cpu / performance.cpu_s;
  }
  record.write(result, pressures);
  record.print(result, rows);
  print_limits(result.longitudinal);
  if (std::isfinite(performance.linear_cpu_s))
    spdlog::info("of these, steady state {:.1f} s of processor, linear solves {:.1f} s{}",
                 performance.steady_cpu_s, performance.linear_cpu_s,
                 meshes > 1 ? fmt::format(", coarser meshes {:.1f} s", coarser_cpu) : "");
  record.print_end(result);
  return result.status;
}

}  // namespace alphadot
