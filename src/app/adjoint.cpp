// The verb "adjoint": what a load is sensitive to, from one linear solve a load.
#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "analysis/table.hpp"
#include "app/case_run.hpp"
#include "app/kept_solutions.hpp"
#include "app/load_case.hpp"
#include "app/stop.hpp"
#include "app/verbs.hpp"
#include "core/csv.hpp"
#include "core/log.hpp"
#include "core/timer.hpp"
#include "derivatives/goal.hpp"
#include "io/files.hpp"
#include "io/vtkhdf.hpp"

namespace alphadot {

namespace {

/// Those asked for; by default every load that symmetry leaves.
std::vector<Functional> functionals_of(const std::vector<std::string>& names, const Case& settings) {
  if (names.empty()) return all_functionals(settings);
  std::vector<Functional> out;
  std::vector<Problem> problems;
  const auto components = components_of(settings);
  for (const auto& name : names)
    collect(problems, [&] {
      auto functional = parse_functional(name, "--of", settings, components);
      if (std::ranges::find(out, functional.name(), &Functional::name) == out.end())
        out.push_back(std::move(functional));
    });
  if (!problems.empty()) throw InputError(std::move(problems));
  return out;
}

std::vector<Goal> goals_of(const std::vector<std::string>& names, const Case& settings) {
  std::vector<Goal> out;
  std::vector<Problem> problems;
  const auto components = components_of(settings);
  for (const auto& name : names)
    collect(problems, [&] {
      auto goal = parse_goal(name, "--indicator", settings, components);
      if (std::ranges::find(out, goal.name(), &Goal::name) == out.end()) out.push_back(std::move(goal));
    });
  if (!problems.empty()) throw InputError(std::move(problems));
  return out;
}

/// Where the mesh's error in the goals is made, for the mesher and for ParaView. False when it was stopped.
bool write_indicator(CaseRun& run, const std::vector<Goal>& goals, const Adjoints& adjoints,
                     const SolveObserver& observer) {
  FlowCase& flow = run.flow();
  Responses responses;
  std::vector<std::string> shortfalls;
  if (!solve_responses(flow, responses, shortfalls, observer)) return false;
  AdjointSolver solver(flow.iteration(), flow.conditions(), flow.settings().derivatives, observer.go_on);
  std::vector<DerivativeChain> chains;
  for (const auto& goal : goals) chains.push_back(chain_of(goal, flow, adjoints, responses));
  const auto found = indicators(flow.iteration(), flow.conditions(), solver, chains);
  if (found.empty()) return false;
  for (const auto& one : found)
    if (auto shortfall =
            shortfall_of_solve("the adjoint of " + one.name + " to the steady flow", one.relative_residual,
                               one.iterations, flow.settings().derivatives.orders);
        !shortfall.empty())
      shortfalls.push_back(std::move(shortfall));
  for (auto& shortfall : shortfalls) run.record().fall_short(std::move(shortfall));
  const auto all = joined(found, run.communicator());
  std::vector<VtkField> fields{{"indicator", all}};
  for (const auto& one : found) fields.emplace_back("indicator_" + one.name, one.of_cells);
  write_flow(run.record().folder() + "/indicator.vtkhdf", flow.setup().domain, fields, run.record().origin(),
             run.communicator());
  return true;
}

/// Which cells the loads listen to: what a unit of mass, momentum and energy fed into a cell in a unit of
/// time does to each.
void write_fields(const CaseRun& run, const std::vector<Functional>& functionals, const Adjoints& adjoints) {
  struct Parts {
    std::vector<Real> mass, energy;
    std::vector<Vec3> momentum;
  };
  std::vector<Parts> parts(functionals.size());
  std::vector<VtkField> fields;
  for (std::size_t i = 0; i < functionals.size(); ++i) {
    for (const auto& psi : adjoints.at(functionals[i].name()).field) {
      parts[i].mass.push_back(psi[0]);
      parts[i].momentum.push_back({psi[1], psi[2], psi[3]});
      parts[i].energy.push_back(psi[4]);
    }
    const std::string name = functionals[i].name();
    fields.emplace_back(name + "_by_mass", parts[i].mass);
    fields.emplace_back(name + "_by_momentum", parts[i].momentum);
    fields.emplace_back(name + "_by_energy", parts[i].energy);
  }
  write_flow(run.record().folder() + "/adjoint.vtkhdf", run.flow().setup().domain, fields,
             run.record().origin(), run.communicator());
}

/// What the place of walls does is not known where they have turned and their mesh has not.
bool turns_walls(const Case& settings) {
  return settings.space.deflection == DeflectionKind::transpiration && !settings.deflections.empty();
}

/// What the place of every point of the walls does to the loads: vectors per area for ParaView, numbers a
/// point in surface_sensitivity.csv.
void write_surface_sensitivity(const CaseRun& run, AdjointDerivatives& solver, const Adjoints& adjoints) {
  std::vector<SurfaceSensitivity> sensitivities;
  std::vector<VtkField> fields;
  std::vector<std::string> cells{"point", "x", "y", "z"};
  for (const auto& functional : solver.functionals()) {
    if (functional.rates > 0) continue;
    sensitivities.push_back(solver.by_shape(functional, adjoints));
    fields.emplace_back(functional.name() + "_by_place", sensitivities.back().density());
    for (const char* axis : {"x", "y", "z"})
      cells.push_back(fmt::format("{}_by_{}", functional.name(), axis));
  }
  if (sensitivities.empty()) return;
  const auto& record = run.record();
  std::string csv = csv_comment("Flow: " + record.origin().text() +
                                "\nderivatives by the place of the walls' points, those inside held; lengths "
                                "in the unit of the reference length\n") +
                    csv_line(cells);
  for (std::size_t point = 0; point < sensitivities[0].points().size(); ++point) {
    const auto& [id, at, unused] = sensitivities[0].points()[point];
    cells = {fmt::format("{}", id)};
    for (int axis = 0; axis < 3; ++axis) cells.push_back(fmt::format("{:.17g}", at[axis]));
    for (const auto& sensitivity : sensitivities)
      for (int axis = 0; axis < 3; ++axis)
        cells.push_back(fmt::format("{:.9g}", sensitivity.points()[point].derivative[axis]));
    csv += csv_line(cells);
  }
  write_surface(record.folder() + "/surface_sensitivity.vtkhdf", run.flow().setup().domain, fields,
                record.origin(), run.communicator());
  run.communicator().on_root([&] { replace_file_with(record.folder() + "/surface_sensitivity.csv", csv); });
}

}  // namespace

RunStatus adjoint_verb(const CaseArguments& arguments, const std::vector<std::string>& of,
                       const std::vector<std::string>& adapt_to, const Communicator& comm) {
  const SignalListener signals;
  const Case settings = load_case(arguments.case_file, arguments.overrides, comm);
  check_has_transpose(settings);
  const auto goals = goals_of(adapt_to, settings);
  auto functionals = of.empty() && !goals.empty() ? std::vector<Functional>{} : functionals_of(of, settings);
  for (const auto& goal : goals)
    if (std::ranges::find(functionals, goal.functional.name(), &Functional::name) == functionals.end())
      functionals.push_back(goal.functional);
  CaseRun run(settings, arguments, "adjoint", comm);
  run.check_not_in_motion();
  auto& record = run.record();
  record.announce();
  if (settings.output.surface && turns_walls(settings))
    spdlog::info("no surface_sensitivity: walls are deflected by transpiration, and their mesh is not");
  std::vector<TableRow> rows;
  Real linear_cpu = not_measured;
  const RunStatus status = run.carry_out([&](RunStatus marched) {
    const Timer timer;
    run.progress().begin_phase("adjoints");
    Adjoints adjoints;
    const LinearSolves solves(run, [&] { keep(run, adjoints); });
    auto solver = std::make_unique<AdjointDerivatives>(run.flow(), functionals, solves.observer());
    adjoints = kept_adjoints(run);
    bool is_done = solver->solve(adjoints);
    if (is_done) {
      std::vector<std::string> shortfalls;
      rows = solver->rows(adjoints, shortfalls);
      for (auto& shortfall : shortfalls) record.fall_short(std::move(shortfall));
      if (settings.output.flow) write_fields(run, functionals, adjoints);
      if (settings.output.surface && !turns_walls(settings))
        write_surface_sensitivity(run, *solver, adjoints);
    }
    solver.reset();  // its matrices are those of the indicator's solver
    if (is_done && !goals.empty()) is_done = write_indicator(run, goals, adjoints, solves.observer());
    linear_cpu = timer.cpu();
    return is_done ? marched : RunStatus::interrupted;
  });
  return run.conclude(status, rows, linear_cpu, "adjoints", "adjoint.csv",
                      [&](const TableHead& head) { return derivative_csv(rows, head); });
}

}  // namespace alphadot
