// The verb "run": steady state, motion, derivatives, files.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <filesystem>
#include <memory>

#include "analysis/table.hpp"
#include "app/extraction.hpp"
#include "app/loads.hpp"
#include "app/pictures.hpp"
#include "app/progress.hpp"
#include "app/setup.hpp"
#include "app/verbs.hpp"
#include "core/error.hpp"
#include "core/log.hpp"
#include "core/timer.hpp"
#include "io/case_file.hpp"
#include "io/files.hpp"
#include "io/history.hpp"
#include "io/result.hpp"
#include "solver/block_lu_sgs.hpp"
#include "solver/lu_sgs.hpp"

namespace alphadot {

namespace {

constexpr int block_sweeps = 2;

std::unique_ptr<LinearSolver> make_linear_solver(const Discretization& discretization,
                                                 const Communicator& comm, SchemeKind scheme) {
  if (scheme == SchemeKind::lu_sgs) return std::make_unique<LuSgs>(discretization, comm);
  return std::make_unique<BlockLuSgs>(discretization, comm, block_sweeps);
}

NamedValues named(const Coefficients& c) {
  NamedValues out;
  for (int i = 0; i < Coefficients::size(); ++i)
    out.emplace_back(std::string(coefficient_names[static_cast<std::size_t>(i)]), c[i]);
  return out;
}

void append(History::Row& row, const std::string& group, const Coefficients& c) {
  for (const auto& [name, value] : named(c)) row.emplace_back(group + "/" + name, value);
}

History::Row history_row(const StepReport& step, const Setup& setup, const Motion& motion) {
  const Case& settings = setup.settings;
  History::Row row{
      {"step", step.step},
      {"time", step.time},
      {"t_star", motion.reduced_time(step.time)},
      {"alpha", step.attitude.alpha},
      {"beta", step.attitude.beta},
      {"phi", step.attitude.angle.x},
      {"theta", step.attitude.angle.y},
      {"psi", step.attitude.angle.z},
      {"q", step.attitude.rotation.y * settings.reference.length / (2 * settings.freestream.mach)},
      {"inner_iterations", step.inner_iterations},
      {"inner_orders", step.inner_orders}};
  append(row, "total", coefficients(step.report.total, settings));
  append(row, "error", coefficients(step.error, settings));
  for (std::size_t patch = 0; patch < setup.patch_kinds.size(); ++patch)
    if (setup.patch_kinds[patch] == BoundaryKind::wall)
      append(row, setup.domain.patch_names[patch], coefficients(step.report.loads[patch], settings));
  return row;
}

/// One run from its setup to its files.
class Run {
 public:
  Run(Setup setup, std::string folder, const Communicator& comm)
      : comm_(comm),
        setup_(std::move(setup)),
        folder_(std::move(folder)),
        discretization_(setup_.domain, setup_.patch_kinds, setup_.settings.space,
                        setup_.settings.freestream.gamma),
        iteration_(discretization_, comm,
                   make_linear_solver(discretization_, comm, setup_.settings.steady.scheme),
                   setup_.settings.reference.moment_center),
        motion_(setup_.settings.motion, setup_.settings.freestream, setup_.settings.reference.length),
        history_(history_info(setup_.settings, setup_.mesh.hash)) {
    describe();
  }

  RunStatus execute() {
    RunStatus status = RunStatus::error;
    try {
      status = steady();
      if (status != RunStatus::interrupted && setup_.settings.motion.kind != MotionKind::none)
        status = unsteady();
    } catch (const DivergedError& error) {
      status = RunStatus::diverged;
      message_ = error.what();
    }
    if (status == RunStatus::diverged) spdlog::error("diverged: {}", message_);
    write(status);
    return status;
  }

 private:
  void describe() {
    const auto excluded = excluded_patches();
    spdlog::info("{} cells, {} points on {} rank{}", setup_.mesh.cells, setup_.mesh.points, comm_.size(),
                 comm_.size() == 1 ? "" : "s");
    if (!excluded.empty()) spdlog::info("left out of the forces: {}", fmt::join(excluded, ", "));
  }

  std::vector<std::string> excluded_patches() const {
    std::vector<std::string> out;
    for (std::size_t patch = 0; patch < setup_.patch_kinds.size(); ++patch) {
      const auto kind = setup_.patch_kinds[patch];
      if (kind == BoundaryKind::jet || kind == BoundaryKind::sting)
        out.push_back(setup_.domain.patch_names[patch]);
    }
    return out;
  }

  RunStatus steady() {
    const Case& settings = setup_.settings;
    const auto conditions =
        steady_conditions(motion_.wind(), settings.motion.axis_point, settings.freestream.gamma);
    iteration_.set_uniform(conditions.free_stream);
    ProgressLines lines(settings);
    const auto result = march_to_steady(iteration_, conditions, settings.steady, settings.space.order,
                                        [&](const SteadyProgress& p) {
                                          lines.show(p);
                                          return true;
                                        });
    loads_ = result.report;
    if (result.status == RunStatus::diverged)
      throw DivergedError("the steady march found no CFL number that holds");
    if (result.status == RunStatus::completed)
      message_ = fmt::format("the residual dropped {:.1f} of {} decades in {} iterations", result.orders,
                             settings.steady.orders, result.iterations);
    return result.status;
  }

  RunStatus unsteady() {
    const Case& settings = setup_.settings;
    const int steps =
        static_cast<int>(std::lround(settings.unsteady.cycles * settings.unsteady.steps_per_cycle));
    const Real time_step = motion_.period() / settings.unsteady.steps_per_cycle;
    DualTime dual_time(iteration_, motion_, settings.motion.axis_point, time_step, loads_.total);
    const InnerTolerance tolerance{settings.unsteady.inner_tolerance * settings.motion.reduced_frequency,
                                   settings.motion.amplitude * radians_per_degree,
                                   settings.unsteady.max_inner};
    ProgressLines lines(settings);
    for (int i = 0; i < steps; ++i) {
      const auto step = dual_time.advance(tolerance);
      lines.show(step, steps);
      history_.append(history_row(step, setup_, motion_));
    }
    extraction_ = extract_derivatives(history_);
    return RunStatus::completed;
  }

  void write(RunStatus status) {
    write_pictures(folder_, setup_, iteration_, comm_);
    Result result = summary(status);
    comm_.on_root([&] {
      if (history_.steps() > 0) write_history(folder_, history_);
      replace_file_with(folder_ + "/case.toml", resolved_case(setup_.settings));
      write_result(folder_ + "/result.json", result);
    });
    if (comm_.is_root()) print(result);
  }

  Result summary(RunStatus status) {
    const Case& settings = setup_.settings;
    Result out;
    out.status = status;
    out.message = message_;
    out.title = settings.title;
    out.mesh = setup_.mesh;
    out.reference = settings.reference;
    out.freestream = settings.freestream;
    out.rate = "length / (2 V)";
    out.axes = "body: x aft, z up for forces; moments nose up and nose to starboard positive";
    out.forces = named(coefficients(loads_.total, settings));
    for (std::size_t patch = 0; patch < loads_.loads.size(); ++patch)
      if (setup_.patch_kinds[patch] == BoundaryKind::wall)
        out.components[setup_.domain.patch_names[patch]] = named(coefficients(loads_.loads[patch], settings));
    out.excluded = excluded_patches();
    for (const auto& row : rows_of(extraction_.derivatives, extraction_.method))
      out.derivatives[row.name] = {row.value.value, row.value.uncertainty, row.method};
    out.performance = performance();
    out.provenance = provenance(comm_.size());
    return out;
  }

  PerformanceResult performance() const {
    PerformanceResult out;
    const Real cells = static_cast<Real>(setup_.mesh.cells);
    out.wall_s = comm_.max(timer_.wall());
    out.cpu_s = comm_.sum(timer_.cpu());
    out.iterations = iteration_.iterations();
    out.core_us_per_cell_iteration =
        1e6 * out.cpu_s / (cells * static_cast<Real>(std::max<GlobalIndex>(out.iterations, 1)));
    out.bytes_per_cell = comm_.sum(static_cast<Real>(iteration_.bytes())) / cells;
    out.halo_fraction = comm_.max(iteration_.halo_seconds()) / out.wall_s;
    return out;
  }

  void print(const Result& result) const {
    const auto loads = coefficients(loads_.total, setup_.settings);
    spdlog::info("\nSteady: CA {:.6f}  CN {:+.6f}  Cm {:+.6f} about x = {:g}", loads.CA, loads.CN, loads.Cm,
                 setup_.settings.reference.moment_center.x);
    if (!extraction_.derivatives.empty())
      spdlog::info("\n{}", derivative_table(rows_of(extraction_.derivatives, extraction_.method),
                                            setup_.settings.reference));
    const auto& p = result.performance;
    spdlog::info(
        "{}: {} wall, {:.1f} s of processor, {} iterations, {:.3f} us of core time per cell and iteration, "
        "{:.0f} bytes per cell, {:.1f} % waiting for halos",
        to_string(result.status), duration_text(p.wall_s), p.cpu_s, p.iterations,
        p.core_us_per_cell_iteration, p.bytes_per_cell, 100 * p.halo_fraction);
    spdlog::info("written to {}", folder_);
  }

  const Communicator& comm_;
  Setup setup_;
  std::string folder_;
  Timer timer_;
  Discretization discretization_;
  ImplicitIteration iteration_;
  Motion motion_;
  History history_;
  FlowReport loads_;  // of the steady state
  Extraction extraction_;
  std::string message_;
};

std::string run_folder(const CaseArguments& arguments, const Case& settings) {
  if (!arguments.folder.empty()) return arguments.folder;
  if (!settings.output.folder.empty()) return settings.output.folder;
  return "runs/" + std::filesystem::path(arguments.case_file).stem().string();
}

}  // namespace

RunStatus run_verb(const CaseArguments& arguments, const Communicator& comm) {
  const Case settings = load_case(arguments.case_file, arguments.overrides, comm);
  const std::string folder = run_folder(arguments, settings);
  comm.on_root([&] { make_run_folder(folder); });
  return Run(load_setup(settings, comm), folder, comm).execute();
}

}  // namespace alphadot
