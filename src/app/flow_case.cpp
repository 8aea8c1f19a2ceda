#include "app/flow_case.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <filesystem>
#include <memory>
#include <utility>

#include "app/loads.hpp"
#include "app/pictures.hpp"
#include "app/progress.hpp"
#include "core/error.hpp"
#include "core/log.hpp"
#include "io/case_file.hpp"
#include "io/files.hpp"
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

std::string run_folder(const CaseArguments& arguments, const Case& settings) {
  return arguments.folder.empty() ? settings.output.folder : arguments.folder;
}

/// The folder is made before the mesh is read, so that a run that cannot write ends at once.
Setup prepare(const CaseArguments& arguments, const Communicator& comm) {
  const Case settings = load_case(arguments.case_file, arguments.overrides, comm);
  comm.on_root([&] { make_run_folder(run_folder(arguments, settings)); });
  return load_setup(settings, comm);
}

}  // namespace

NamedValues named(const Coefficients& coefficients) {
  NamedValues out;
  for (int i = 0; i < Coefficients::size(); ++i)
    out.emplace_back(std::string(coefficient_names[static_cast<std::size_t>(i)]), coefficients[i]);
  return out;
}

FlowCase::FlowCase(const CaseArguments& arguments, const Communicator& comm)
    : comm_(comm),
      setup_(prepare(arguments, comm)),
      folder_(run_folder(arguments, setup_.settings)),
      discretization_(setup_.domain, setup_.patch_kinds, setup_.settings.space,
                      setup_.settings.freestream.gamma),
      iteration_(discretization_, comm,
                 make_linear_solver(discretization_, comm, setup_.settings.steady.scheme),
                 setup_.settings.reference.moment_center),
      motion_(setup_.settings.motion, setup_.settings.freestream, setup_.settings.reference.length) {
  spdlog::info("{} cells, {} points on {} rank{}", setup_.mesh.cells, setup_.mesh.points, comm.size(),
               comm.size() == 1 ? "" : "s");
  const auto excluded = excluded_patches();
  if (!excluded.empty()) spdlog::info("left out of the forces: {}", fmt::join(excluded, ", "));
}

Conditions<Real> FlowCase::conditions() const {
  return steady_conditions(motion_.wind(), settings().motion.axis_point, settings().freestream.gamma);
}

RunStatus FlowCase::march() {
  const auto now = conditions();
  iteration_.set_uniform(now.free_stream);
  ProgressLines lines(settings());
  const auto result = march_to_steady(iteration_, now, settings().steady, settings().space.order,
                                      [&](const SteadyProgress& p) {
                                        lines.show(p);
                                        return true;
                                      });
  steady_report_ = result.report;
  if (result.status == RunStatus::diverged)
    throw DivergedError("the steady march found no CFL number that holds");
  if (result.status == RunStatus::completed) {
    message_ = fmt::format("the residual dropped {:.1f} of {} decades in {} iterations", result.orders,
                           settings().steady.orders, result.iterations);
    spdlog::warn("{}", message_);
  }
  return result.status;
}

std::vector<std::string> FlowCase::excluded_patches() const {
  std::vector<std::string> out;
  for (std::size_t patch = 0; patch < setup_.patch_kinds.size(); ++patch) {
    const auto kind = setup_.patch_kinds[patch];
    if (kind == BoundaryKind::jet || kind == BoundaryKind::sting)
      out.push_back(setup_.domain.patch_names[patch]);
  }
  return out;
}

PerformanceResult FlowCase::performance() const {
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

Result FlowCase::result(RunStatus status) const {
  Result out;
  out.status = status;
  out.message = message_;
  out.title = settings().title;
  out.mesh = setup_.mesh;
  out.reference = settings().reference;
  out.freestream = settings().freestream;
  out.rate = "length / (2 V)";
  out.axes = "body: x aft, z up for forces; moments nose up and nose to starboard positive";
  out.forces = named(coefficients(steady_report_.total, settings()));
  for (std::size_t patch = 0; patch < steady_report_.loads.size(); ++patch)
    if (setup_.patch_kinds[patch] == BoundaryKind::wall)
      out.components[setup_.domain.patch_names[patch]] =
          named(coefficients(steady_report_.loads[patch], settings()));
  out.excluded = excluded_patches();
  out.performance = performance();
  out.provenance = provenance(comm_.size());
  return out;
}

void FlowCase::write(const Result& result) const {
  write_pictures(folder_, setup_, iteration_, comm_);
  comm_.on_root([&] {
    replace_file_with(folder_ + "/case.toml", resolved_case(settings()));
    write_result(folder_ + "/result.json", result);
  });
}

void FlowCase::print(const Result& result) const {
  const auto loads = coefficients(steady_report_.total, settings());
  spdlog::info("\nSteady: CA {:.6f}  CN {:+.6f}  Cm {:+.6f} about x = {:g}", loads.CA, loads.CN, loads.Cm,
               settings().reference.moment_center.x);
  const auto& p = result.performance;
  spdlog::info(
      "{}: {} wall, {:.1f} s of processor, {} iterations, {:.3f} us of core time per cell and iteration, "
      "{:.0f} bytes per cell, {:.1f} % waiting for halos\nwritten to {}",
      to_string(result.status), duration_text(p.wall_s), p.cpu_s, p.iterations, p.core_us_per_cell_iteration,
      p.bytes_per_cell, 100 * p.halo_fraction, folder_);
}

}  // namespace alphadot
