// The verb "adjoint": what a load is sensitive to, from one linear solve a load.
#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "analysis/table.hpp"
#include "app/adjoint.hpp"
#include "app/adjoints.hpp"
#include "app/steady_restart.hpp"
#include "app/stop.hpp"
#include "app/watchdog.hpp"
#include "core/error.hpp"
#include "core/log.hpp"
#include "core/timer.hpp"
#include "derivatives/block_solve.hpp"
#include "derivatives/stream_change.hpp"
#include "derivatives/surface_sensitivity.hpp"
#include "io/files.hpp"
#include "io/vtkhdf.hpp"

namespace alphadot {

namespace {

/// Those asked for; by default every load that symmetry leaves.
std::vector<Functional> functionals_of(std::vector<std::string> names, const Case& settings) {
  if (names.empty()) {
    const bool half = settings.reference.half_model;
    for (const std::string_view name : coefficient_names)
      if (!half || name == "CA" || name == "CN" || name == "Cm") names.emplace_back(name);
  }
  std::vector<Functional> out;
  for (const auto& name : names) out.push_back(parse_functional(name, "--of", settings, settings.boundary));
  return out;
}

/// What has to be solved for, by the length of the chain: adjoints to rates rest on those before them.
std::vector<std::vector<Functional>> chains_of(const std::vector<Functional>& functionals) {
  std::vector<std::vector<Functional>> out;
  for (const int rates : {0, 1, 2}) {
    auto& links = out.emplace_back();
    for (const auto& functional : functionals) {
      const Functional link{functional.coefficient, functional.patches, rates};
      if (functional.rates >= rates &&
          std::ranges::find(links, link.name(), &Functional::name) == links.end())
        links.push_back(link);
    }
  }
  return out;
}

/// Solves for all adjoints but those that the checkpoint has, with a checkpoint after each group. False when
/// the run was stopped.
bool solve_all(FlowCase& flow, const std::vector<Functional>& functionals, AdjointSolver& solver,
               Adjoints& adjoints) {
  for (const auto& links : chains_of(functionals)) {
    std::vector<AdjointProblem> problems;
    for (const auto& link : links) {
      if (adjoints.has(link)) continue;
      if (link.rates == 0)
        problems.push_back({link.name(), weights_of(link, flow.setup().domain.patch_names, flow.settings())});
      else
        problems.push_back(
            {link.name(), {}, adjoints.at(link.before()).field, adjoints.at(link.before()).relative_error});
    }
    for (std::size_t begin = 0; begin < problems.size(); begin += problems_at_a_time) {
      const auto end = std::min(begin + problems_at_a_time, problems.size());
      auto solved = solver.solve({problems.begin() + static_cast<std::ptrdiff_t>(begin),
                                  problems.begin() + static_cast<std::ptrdiff_t>(end)});
      if (solved.empty()) return false;
      for (auto& adjoint : solved) {
        spdlog::info("{:12} {:3} iterations, linear residual {:.1e}", adjoint.name, adjoint.iterations,
                     adjoint.relative_residual);
        adjoints.add(std::move(adjoint));
      }
      adjoints.save();
    }
  }
  return true;
}

/// Names of the functionals whose adjoints, or those that they rest on, did not reach what was asked for. Of
/// a flow that has not come far to rest none has: what it leaves in the derivatives is in no uncertainty
/// here.
std::set<std::string> unconverged(FlowCase& flow, const std::vector<Functional>& functionals,
                                  const Adjoints& adjoints) {
  const bool is_deep = flow.steady_orders() >= deep_steady_orders;
  if (!is_deep)
    flow.fall_short(fmt::format("adjoints are about a flow {:.1f} decades down, and need {:g}",
                                flow.steady_orders(), deep_steady_orders));
  std::set<std::string> out;
  for (const auto& links : chains_of(functionals))
    for (const auto& link : links) {
      const Adjoint& adjoint = adjoints.at(link);
      const bool rests_on_it = link.rates > 0 && out.contains(link.before().name());
      if (!flow.reached("the adjoint of " + link.name(), adjoint.relative_residual, adjoint.iterations) ||
          !is_deep || rests_on_it)
        out.insert(link.name());
    }
  return out;
}

std::vector<TableRow> rows_of(FlowCase& flow, const std::vector<Functional>& functionals,
                              const Adjoints& adjoints, std::span<const StreamChange> stream) {
  const Case& settings = flow.settings();
  const auto fell_short = unconverged(flow, functionals, adjoints);
  std::vector<TableRow> rows;
  for (const auto& functional : functionals) {
    const Adjoint& adjoint = adjoints.at(functional);
    const std::size_t first = rows.size();
    for (const Variable variable : variables_of(functional, settings))
      rows.push_back({derivative_name(functional, name(variable)), derivative(adjoint, variable, settings),
                      "adjoint, k -> 0"});
    for (std::size_t i = 0; functional.rates == 0 && i < stream.size(); ++i)
      rows.push_back({derivative_name(functional, stream[i].name()),
                      {stream[i].by_itself(functional, flow.setup().domain.patch_names) + adjoint.products[i],
                       adjoint.products_error[i]},
                      "adjoint, incidence and reduced rates held"});
    for (std::size_t i = first; i < rows.size(); ++i)
      rows[i].converged = !fell_short.contains(functional.name());
  }
  return rows;
}

/// Which cells the loads listen to: what a unit of mass, momentum and energy fed into a cell in a unit of
/// time does to each.
void write_fields(const FlowCase& flow, const std::vector<Functional>& functionals,
                  const Adjoints& adjoints) {
  struct Parts {
    std::vector<Real> mass, energy;
    std::vector<Vec3> momentum;
  };
  std::vector<Parts> parts(functionals.size());
  std::vector<VtkField> fields;
  for (std::size_t i = 0; i < functionals.size(); ++i) {
    for (const auto& psi : adjoints.at(functionals[i]).field) {
      parts[i].mass.push_back(psi[0]);
      parts[i].momentum.push_back({psi[1], psi[2], psi[3]});
      parts[i].energy.push_back(psi[4]);
    }
    const std::string name = functionals[i].name();
    fields.emplace_back(name + "_by_mass", parts[i].mass);
    fields.emplace_back(name + "_by_momentum", parts[i].momentum);
    fields.emplace_back(name + "_by_energy", parts[i].energy);
  }
  write_flow(flow.folder() + "/adjoint.vtkhdf", flow.setup().domain, fields, flow.origin(),
             flow.communicator());
}

/// What the place of every point of the walls does to the loads: vectors per area for ParaView, numbers a
/// point in surface_sensitivity.csv.
void write_surface_sensitivity(FlowCase& flow, const std::vector<Functional>& functionals,
                               const Adjoints& adjoints, AdjointSolver& solver) {
  const Subdomain& domain = flow.setup().domain;
  std::vector<std::string> names;
  std::vector<SurfaceSensitivity> sensitivities;
  std::vector<VtkField> fields;
  for (const auto& functional : functionals) {
    if (functional.rates > 0) continue;
    const auto weights = weights_of(functional, domain.patch_names, flow.settings());
    names.push_back(functional.name());
    sensitivities.emplace_back(flow.iteration().discretization(), flow.communicator(),
                               solver.by_points(adjoints.at(functional), weights));
  }
  if (names.empty()) return;
  std::string csv = "# Flow: " + flow.origin().text() +
                    "\n# derivatives by the place of the walls' points, those inside held; lengths in mesh "
                    "units\npoint,x,y,z";
  for (std::size_t i = 0; i < names.size(); ++i) {
    fields.emplace_back(names[i] + "_by_place", sensitivities[i].density());
    csv += fmt::format(",{0}_by_x,{0}_by_y,{0}_by_z", names[i]);
  }
  for (std::size_t point = 0; point < sensitivities[0].points().size(); ++point) {
    const auto& [id, at, unused] = sensitivities[0].points()[point];
    csv += fmt::format("\n{},{:.17g},{:.17g},{:.17g}", id, at.x, at.y, at.z);
    for (const auto& sensitivity : sensitivities) {
      const Vec3& by = sensitivity.points()[point].derivative;
      csv += fmt::format(",{:.9g},{:.9g},{:.9g}", by.x, by.y, by.z);
    }
  }
  write_surface(flow.folder() + "/surface_sensitivity.vtkhdf", domain, fields, flow.origin(),
                flow.communicator());
  flow.communicator().on_root(
      [&] { replace_file_with(flow.folder() + "/surface_sensitivity.csv", csv + "\n"); });
}

void check_scheme(const Case& settings) {
  if (settings.steady.scheme == SchemeKind::lu_sgs)
    throw InputError(settings.file, 0, "the adjoint needs an implicit scheme that has a transpose",
                     "set steady.scheme = \"block_lu_sgs\"");
}

/// Whether there is a sensitivity to the shape.
bool has_shape(const Case& settings) {
  const bool out = settings.space.order == 1 || settings.space.gradient == GradientKind::least_squares;
  if (!out) spdlog::warn("no sensitivity to the shape: it needs space.gradient = \"least_squares\"");
  return out;
}

}  // namespace

RunStatus adjoint_verb(const CaseArguments& arguments, const std::vector<std::string>& of,
                       const Communicator& comm) {
  const SignalListener signals;
  FlowCase flow(load_case(arguments.case_file, arguments.overrides, comm), arguments, "adjoint", comm);
  check_scheme(flow.settings());
  const auto functionals = functionals_of(of, flow.settings());
  check_steady_restart(flow);
  flow.announce();
  RunStatus status = RunStatus::error;
  std::vector<TableRow> rows;
  Real linear_cpu = not_measured;
  try {
    status = flow.march();
    const Timer timer;
    if (status != RunStatus::interrupted) {
      flow.progress().begin_phase("adjoints");
      std::atomic<GlobalIndex> linear_iterations{0};
      const Watchdog watchdog(
          flow.settings().checkpoint.watchdog_minutes, [&] { return linear_iterations.load(); }, comm);
      std::vector<StreamChange> stream;
      std::vector<std::span<const Conserved<Real>>> changes;
      for (const auto& number : stream_numbers)
        stream.emplace_back(flow.iteration(), flow.settings(), number);
      for (const auto& change : stream) changes.push_back(change.residual());
      AdjointSolver solver(flow.iteration(), flow.conditions(), flow.settings().derivatives, [&] {
        ++linear_iterations;
        return !flow.checkpoints().request(false).stop;
      });
      solver.follow(std::move(changes));
      Adjoints adjoints(flow);
      if (solve_all(flow, functionals, solver, adjoints)) {
        rows = rows_of(flow, functionals, adjoints, stream);
        if (flow.settings().output.flow) write_fields(flow, functionals, adjoints);
        if (has_shape(flow.settings()) && flow.settings().output.surface)
          write_surface_sensitivity(flow, functionals, adjoints, solver);
      } else {
        status = RunStatus::interrupted;
        flow.set_message(flow.checkpoints().stop_reason());
      }
    }
    linear_cpu = timer.cpu();
  } catch (const DivergedError& error) {
    status = RunStatus::diverged;
    flow.report_divergence(error);
  }
  Result result = flow.result(status, rows);
  result.performance.linear_cpu_s = comm.sum(linear_cpu);
  if (!rows.empty())
    comm.on_root([&] {
      replace_file_with(flow.folder() + "/adjoint.csv",
                        derivative_csv(rows, flow.table_head(result.status, rows)));
    });
  flow.write(result);
  flow.print(result, rows);
  spdlog::info("of these, steady state {:.1f} s of processor, adjoints {:.1f} s",
               result.performance.steady_cpu_s, result.performance.linear_cpu_s);
  flow.print_end(result);
  return result.status;
}

}  // namespace alphadot
