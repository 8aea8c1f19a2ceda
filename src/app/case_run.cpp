#include "app/case_run.hpp"

#include <fmt/ranges.h>

#include <cmath>
#include <utility>

#include "app/stop.hpp"
#include "app/watchdog.hpp"
#include "core/error.hpp"
#include "core/log.hpp"
#include "io/files.hpp"

namespace alphadot {

namespace {

std::string folder_of(const RunOptions& options, const Case& settings) {
  return options.folder.empty() ? settings.output.folder : options.folder;
}

/// The folder is made before the mesh is read, so that a run that cannot write ends at once.
Setup prepare(const Case& settings, const RunOptions& options, const std::string& verb,
              std::unique_ptr<RunFolder>& folder, const Communicator& comm) {
  comm.on_root([&] { folder = std::make_unique<RunFolder>(folder_of(options, settings)); });
  Setup out = load_setup(settings, comm);
  comm.on_root([&] { folder->admit(out, verb, options.may_overwrite); });
  return out;
}

}  // namespace

CaseRun::CaseRun(const Case& settings, const RunOptions& options, const std::string& verb,
                 const Communicator& comm)
    : folder_(folder_of(options, settings)),
      flow_(prepare(settings, options, verb, run_folder_, comm), comm),
      checkpoints_(flow_.setup(), folder_, options.stop_folder.empty() ? folder_ : options.stop_folder,
                   since_start_, comm),
      record_(flow_, checkpoints_, std::move(run_folder_), folder_, verb, since_start_),
      contents_(flow_, checkpoints_, record_),
      progress_(flow_.settings(), record_.origin(), folder_, comm.is_root()) {
  const Setup& setup = flow_.setup();
  const Real cells = static_cast<Real>(setup.mesh.cells);
  const auto& memory = setup.memory;
  spdlog::info(
      "{} cells, {} points on {} rank{}; bytes a cell: mesh {:.0f}, while reading at most {:.0f}; busiest "
      "rank "
      "{:.2f} GB",
      setup.mesh.cells, setup.mesh.points, comm.size(), comm.size() == 1 ? "" : "s", memory.arrays / cells,
      memory.peak / cells, 1e-9 * memory.busiest_rank);
  for (const auto& warning : setup.warnings) spdlog::warn("{}", warning);
  const auto excluded = excluded_patches(setup);
  if (!excluded.empty()) spdlog::info("left out of the forces: {}", fmt::join(excluded, ", "));
  flow_.iteration().take_along(checkpoints_.reduction());
  if (options.restart) checkpoints_.begin_from(*options.restart);
  if (record_.holds_other()) checkpoints_.leave_others_alone();
}

RunStatus CaseRun::march() {
  stops_safely();
  if (const auto* restart = checkpoints_.restart()) {
    if (restart->phase == "motion") {
      contents_.restore_steady();
      return RunStatus::converged;
    }
    contents_.restore_march();
  }
  int saved = flow_.march_state().steady.iteration, latest = saved;
  progress_.begin_steady(saved);
  const auto& checkpoint = settings().checkpoint;
  const Watchdog watchdog(
      checkpoint.watchdog_minutes, [&] { return flow_.iteration().iterations(); }, communicator());
  auto krylov = KrylovSteps::not_yet;
  const auto observe = [&](const SteadyProgress& p) {
    if (p.iteration <= latest) {  // the march has begun again
      saved = 0;
      krylov = p.state.krylov;
      progress_.begin_steady(0);
    }
    latest = p.iteration;
    progress_.show(p);
    if (p.state.krylov != std::exchange(krylov, p.state.krylov))
      spdlog::info("{} from iteration {} on",
                   krylov == KrylovSteps::taken ? "Newton-Krylov steps" : "the implicit scheme alone",
                   p.iteration + 1);
    const Request request =
        checkpoints_.request(checkpoint.iterations > 0 && p.iteration % checkpoint.iterations == 0);
    if (request.save && p.resumable) {
      contents_.save(contents_.steady_head("steady"));
      saved = p.iteration;
    }
    return !(request.stop && p.resumable);
  };
  struct Measured {  // also a march that diverges
    ~Measured() { record.add_steady_time(timer); }
    RunRecord& record;
    Timer timer = {};
  };
  RunStatus status;
  {
    const Measured measured{record_};
    status = flow_.march(observe);
  }
  if (status == RunStatus::interrupted) record_.set_message(checkpoints_.stop_reason());
  if (flow_.shortfall()) record_.fall_short(*flow_.shortfall());
  if (flow_.march_state().steady.iteration > saved) contents_.save(contents_.steady_head("steady"));
  return status;
}

RunStatus CaseRun::carry_out(const std::function<RunStatus(RunStatus)>& about_it) {
  try {
    const RunStatus marched = march();
    if (marched == RunStatus::interrupted) return marched;
    const RunStatus status = about_it(marched);
    if (status == RunStatus::interrupted) record_.set_message(checkpoints_.stop_reason());
    return status;
  } catch (const DivergedError& error) {
    record_.report_divergence(error);
    return RunStatus::diverged;
  }
}

void CaseRun::check_not_in_motion() const {
  const auto* restart = checkpoints_.restart();
  if (restart && restart->phase == "motion")
    throw InputError(
        folder_, 0, "the checkpoint to go on from was made in a motion",
        "name that of the steady state with --restart FILE, or begin in another folder with --out DIR");
}

RunStatus CaseRun::conclude(RunStatus end, std::span<const TableRow> rows, Real linear_cpu,
                            std::string_view solves, const std::string& table,
                            const std::function<std::string(const TableHead&)>& csv) {
  Result result = record_.result(end, rows);
  result.performance.linear_cpu_s = communicator().sum(linear_cpu);
  if (!rows.empty())
    communicator().on_root([&] {
      replace_file_with(record_.folder() + "/" + table, csv(record_.table_head(result.status, rows)));
    });
  record_.write(result);
  record_.print(result, rows);
  if (std::isfinite(result.performance.linear_cpu_s))
    spdlog::info("of these, steady state {:.1f} s of processor, {} {:.1f} s", result.performance.steady_cpu_s,
                 solves, result.performance.linear_cpu_s);
  record_.print_end(result);
  return result.status;
}

}  // namespace alphadot
