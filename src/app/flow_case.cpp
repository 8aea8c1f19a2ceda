#include "app/flow_case.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <utility>

#include "app/configuration_view.hpp"
#include "app/motion_setup.hpp"
#include "app/pictures.hpp"
#include "app/stop.hpp"
#include "app/watchdog.hpp"
#include "core/error.hpp"
#include "core/log.hpp"
#include "core/memory.hpp"
#include "derivatives/loads.hpp"
#include "io/case_file.hpp"
#include "io/files.hpp"
#include "linear/block_lu_sgs.hpp"
#include "linear/gmres.hpp"
#include "linear/lu_sgs.hpp"

namespace alphadot {

namespace {

std::unique_ptr<LinearSolver> make_linear_solver(const Discretization& discretization,
                                                 const Communicator& comm, const SteadySettings& settings,
                                                 PassOrder order) {
  std::unique_ptr<LinearSolver> out;
  if (settings.scheme == SchemeKind::lu_sgs)
    out = std::make_unique<LuSgs>(discretization, comm);
  else
    out = std::make_unique<BlockLuSgs>(discretization, comm, settings.sweeps, order);
  if (settings.krylov_directions == 0) return out;
  return std::make_unique<Gmres>(discretization, comm, std::move(out), settings.krylov_directions);
}

std::string run_folder(const RunOptions& options, const Case& settings) {
  return options.folder.empty() ? settings.output.folder : options.folder;
}

/// The folder is made before the mesh is read, so that a run that cannot write ends at once.
Setup prepare(const Case& settings, const RunOptions& options, const std::string& verb,
              std::unique_ptr<RunFolder>& folder, const Communicator& comm) {
  comm.on_root([&] { folder = std::make_unique<RunFolder>(run_folder(options, settings)); });
  Setup out = load_setup(settings, comm);
  comm.on_root([&] { folder->admit(out, verb, options.may_overwrite); });
  return out;
}

/// Limits of the CFL number, beside the case's own, for flows that bold steps drive into vacuum (strong
/// shocks, high incidence); tried one after the other. With the last one the scheme is nearly an explicit
/// one: it comes to rest slowly, and follows flow that is not steady at all.
constexpr std::array gentle_limits{1e6, 30.0, 4.0};

/// Share of the limiter's threshold with which a march that stalls begins again, once: the wake of a base has
/// no steady state until it is damped enough. Not where so many decades are reached.
constexpr Real damped_share = 0.25, well_converged = 6;

/// Steps of a march that begins again for the so manieth time.
SteadySettings gentler(SteadySettings settings, std::size_t attempt) {
  if (attempt == 0) return settings;
  settings.cfl_start = std::min(settings.cfl_start / 10, gentle_limits.at(attempt - 1));
  settings.cfl_growth = std::pow(settings.cfl_growth, 0.4);
  settings.cfl_max = std::min(settings.cfl_max, gentle_limits.at(attempt - 1));
  return settings;
}

constexpr std::size_t named_in_message = 3;

/// Begins what was not reached in the message of a checkpoint.
const std::string not_reached_mark = "\nnot reached: ";

/// "cell 7 at (1, 2, 3), cell 8 at ..."
std::string named(std::span<const SuspectCell> cells) {
  std::vector<std::string> out;
  for (const auto& [id, at, change] : cells)
    out.push_back(fmt::format("cell {} at ({:.5g}, {:.5g}, {:.5g})", id, at.x, at.y, at.z));
  return fmt::format("{}", fmt::join(out, ", "));
}

}  // namespace

NamedValues named(const Coefficients& coefficients) {
  NamedValues out;
  for (int i = 0; i < Coefficients::size(); ++i)
    out.emplace_back(std::string(coefficient_names[static_cast<std::size_t>(i)]), coefficients[i]);
  return out;
}

FlowCase::FlowCase(const Case& settings, const RunOptions& options, std::string verb,
                   const Communicator& comm)
    : comm_(comm),
      verb_(std::move(verb)),
      setup_(prepare(settings, options, verb_, run_folder_, comm)),
      folder_(run_folder(options, setup_.settings)),
      holds_result_(comm.any(run_folder_ && run_folder_->holds_result())),
      origin_(history_info(setup_.settings, setup_.mesh.hash).origin()),
      checkpoints_(setup_, folder_, options.stop_folder.empty() ? folder_ : options.stop_folder, timer_,
                   comm),
      progress_(setup_.settings, origin_, folder_, comm.is_root()),
      discretization_(setup_.domain, setup_.patch_kinds, setup_.settings.space,
                      setup_.settings.freestream.gamma),
      motion_(make_motion(setup_)),
      iteration_(
          discretization_, comm,
          make_linear_solver(discretization_, comm, setup_.settings.steady, pass_order(motion_.wind().x)),
          setup_.settings.reference.moment_center) {
  const Real cells = static_cast<Real>(setup_.mesh.cells);
  const auto& memory = setup_.memory;
  spdlog::info(
      "{} cells, {} points on {} rank{}; bytes a cell: mesh {:.0f}, while reading at most {:.0f}; busiest "
      "rank "
      "{:.2f} GB",
      setup_.mesh.cells, setup_.mesh.points, comm.size(), comm.size() == 1 ? "" : "s", memory.arrays / cells,
      memory.peak / cells, 1e-9 * memory.busiest_rank);
  const auto excluded = excluded_patches();
  for (const auto& warning : setup_.warnings) spdlog::warn("{}", warning);
  if (!excluded.empty()) spdlog::info("left out of the forces: {}", fmt::join(excluded, ", "));
  iteration_.take_along(checkpoints_.reduction());
  if (options.restart) checkpoints_.begin_from(*options.restart);
  if (run_folder_ && run_folder_->holds_other()) checkpoints_.leave_others_alone();
}

Conditions<Real> FlowCase::conditions() const {
  return steady_conditions(motion_.wind(), settings().motion.axis_point, settings().freestream.gamma,
                           motion_.steady_rotation());
}

std::unique_ptr<Treatment> FlowCase::treatment(Real time_step) {
  return make_treatment(settings().motion.treatment, motion_, settings().motion.axis_point, time_step,
                        setup_.domain, discretization_, comm_);
}

std::vector<Five<Real>> FlowCase::frozen_factors() {
  std::vector<Five<Real>> out;
  if (iteration_.limiter_is_frozen())
    for (const auto& factors : iteration_.limiter_factors()) {
      auto& cell = out.emplace_back();
      for (int k = 0; k < 5; ++k) cell[k] = factors[k];
    }
  return out;
}

void FlowCase::save(const CheckpointHead& head, std::vector<CheckpointField> others) {
  auto factors = frozen_factors();
  others.push_back({"flow", iteration_.flow().values()});
  if (iteration_.limiter_is_frozen()) others.push_back({"limiter_factors", factors});
  checkpoints_.save(head, others);
}

void FlowCase::restore(std::vector<CheckpointField> others) {
  const auto& numbers = checkpoints_.restart()->numbers;
  discretization_.set_limiter_threshold(numbers.at("limiter_threshold").at(0));
  iteration_.freeze_limiter(numbers.at("limiter_is_frozen").at(0) != 0);
  auto factors = frozen_factors();
  others.push_back({"flow", iteration_.flow().values()});
  if (iteration_.limiter_is_frozen()) others.push_back({"limiter_factors", factors});
  checkpoints_.read(others);
  for (std::size_t cell = 0; cell < factors.size(); ++cell)
    for (int k = 0; k < 5; ++k) iteration_.limiter_factors()[cell][k] = static_cast<float>(factors[cell][k]);
}

CheckpointHead FlowCase::checkpoint_head(std::string phase) const {
  CheckpointHead out;
  out.phase = std::move(phase);
  out.message = message_;
  for (const auto& shortfall : shortfalls_) out.message += not_reached_mark + shortfall;
  out.history.info = history_info(settings(), setup_.mesh.hash, setup_.motion_table_hash);
  out.numbers["limiter_is_frozen"] = {iteration_.limiter_is_frozen() ? 1.0 : 0.0};
  out.numbers["limiter_threshold"] = {discretization_.space().limiter_threshold};
  out.numbers["steady_loads"] = numbers_of(steady_report_.loads);
  return out;
}

void FlowCase::restore_steady(const CheckpointHead& head) {
  auto rest = head.message;
  for (std::size_t at; (at = rest.rfind(not_reached_mark)) != std::string::npos; rest.resize(at))
    shortfalls_.insert(shortfalls_.begin(), rest.substr(at + not_reached_mark.size()));
  message_ = rest;
  steady_report_ = {};
  steady_report_.loads = loads_of(head.numbers.at("steady_loads"));
  steady_report_.total = total_of(steady_report_.loads);
}

CheckpointHead FlowCase::steady_head(std::string phase) const {
  auto out = checkpoint_head(std::move(phase));
  out.numbers["iteration"] = {static_cast<Real>(steady_state_.iteration)};
  out.numbers["attempt"] = {static_cast<Real>(steady_attempt_)};
  out.numbers["cfl"] = {steady_state_.cfl};
  out.numbers["residuals"] = {steady_state_.first_residual, steady_state_.previous_residual};
  out.numbers["lowest_residual"] = {steady_state_.lowest_residual,
                                    static_cast<Real>(steady_state_.lowest_at)};
  out.numbers["load_range"] = numbers_of(std::array{steady_state_.least, steady_state_.most});
  return out;
}

RunStatus FlowCase::march() {
  stops_safely();
  const auto* restart = checkpoints_.restart();
  if (restart && restart->phase == "motion") {
    restore_steady(*restart);
    return RunStatus::converged;
  }
  const auto now = conditions();
  if (restart) {
    const auto& numbers = restart->numbers;
    steady_attempt_ = static_cast<std::size_t>(numbers.at("attempt").at(0));
    const auto range = loads_of(numbers.at("load_range"));
    steady_state_ = {static_cast<int>(numbers.at("iteration").at(0)),
                     numbers.at("cfl").at(0),
                     numbers.at("residuals").at(0),
                     numbers.at("residuals").at(1),
                     numbers.at("lowest_residual").at(0),
                     static_cast<int>(numbers.at("lowest_residual").at(1)),
                     range.at(0),
                     range.at(1)};
    restore();
  } else {
    iteration_.set_uniform(now.free_stream);
  }
  const Real asked_threshold = settings().space.limiter_threshold;
  const auto limiter_threshold = [&] { return discretization_.space().limiter_threshold; };
  int saved = steady_state_.iteration;
  progress_.begin_steady(saved);
  const Watchdog watchdog(
      settings().checkpoint.watchdog_minutes, [&] { return iteration_.iterations(); }, comm_);
  const int interval = settings().checkpoint.iterations;
  const auto observe = [&](const SteadyProgress& p) {
    progress_.show(p);
    steady_state_ = p.state;
    const Request request = checkpoints_.request(interval > 0 && p.iteration % interval == 0);
    if (request.save && p.resumable) {
      save(steady_head("steady"));
      saved = steady_state_.iteration;
    }
    return !(request.stop && p.resumable);
  };
  const Timer timer;
  const auto march_on = [&] {
    return march_to_steady(iteration_, now, gentler(settings().steady, steady_attempt_),
                           settings().space.order, observe, steady_state_);
  };
  const auto begin_again = [&] {
    iteration_.set_uniform(now.free_stream);
    iteration_.freeze_limiter(false);
    steady_state_ = {};
    saved = 0;
    progress_.begin_steady(0);
    return march_on();
  };
  auto result = march_on();
  while (true) {
    if (result.status == RunStatus::diverged && steady_attempt_ < gentle_limits.size()) {
      spdlog::warn("the steady march lost its way in iteration {}: beginning again with gentler steps",
                   result.iterations);
      ++steady_attempt_;
    } else if (result.has_stalled && result.orders < well_converged &&
               limiter_threshold() == asked_threshold) {
      discretization_.set_limiter_threshold(damped_share * asked_threshold);
      message_ = fmt::format(
          "the steady march stalls {:.1f} decades down with space.limiter_threshold = {:g}, "
          "which was lowered to {:g}",
          result.orders, asked_threshold, limiter_threshold());
      spdlog::warn("{}: beginning again", message_);
    } else {
      break;
    }
    result = begin_again();
  }
  steady_wall_ = timer.wall();
  steady_cpu_ = timer.cpu();
  steady_report_ = result.report;
  steady_orders_ = result.free_orders;
  if (result.status == RunStatus::interrupted) message_ = checkpoints_.stop_reason();
  if (const auto& report = result.report; report.positivity_cells + report.positivity_faces > 0)
    spdlog::info(
        "{} cells and {} more faces fall back towards first order to keep density and pressure positive",
        report.positivity_cells, report.positivity_faces);
  if (result.status == RunStatus::diverged)
    throw DivergedError(
        "the steady march found no CFL number that holds (at high incidence "
        "space.flux = \"van_leer\" or \"hllc\" holds where \"roe\" does not)");
  const bool fell_short = result.status == RunStatus::completed || result.status == RunStatus::unconverged;
  if (fell_short) {
    auto text = fmt::format("the steady residual dropped {:.1f} of {:g} decades in {} iterations",
                            result.orders, settings().steady.orders, result.iterations);
    if (result.has_stalled)
      text += fmt::format(" and falls no more, meanwhile CN goes to and fro by {:.1e}, Cm by {:.1e}",
                          coefficients(result.swing, settings()).CN,
                          std::abs(coefficients(result.swing, settings()).Cm));
    fall_short(text + ", worst: " + named(iteration_.worst_cells(named_in_message)));
  }
  if (steady_state_.iteration > saved) save(steady_head("steady"));
  return fell_short ? RunStatus::unconverged : result.status;
}

bool FlowCase::reached(std::string_view what, Real relative_residual, int iterations) {
  const Real asked = settings().derivatives.orders;
  if (relative_residual <= std::pow(10.0, -asked)) return true;
  fall_short(fmt::format("the linear residual for {} dropped {:.1f} of {:g} decades in {} iterations", what,
                         -std::log10(relative_residual), asked, iterations));
  return false;
}

void FlowCase::fall_short(std::string of_what) {
  spdlog::warn("not reached: {}", of_what);
  shortfalls_.push_back(std::move(of_what));
}

RunStatus FlowCase::status_of(RunStatus end) const {
  const bool is_good = end == RunStatus::converged || end == RunStatus::completed;
  return is_good && !shortfalls_.empty() ? RunStatus::unconverged : end;
}

TableHead FlowCase::table_head(RunStatus end, std::span<const TableRow> rows) const {
  std::string status = to_string(status_of(end));
  if (!shortfalls_.empty()) status += fmt::format(": {}", fmt::join(shortfalls_, "; "));
  return {settings().reference, status, uncertainty_scope(rows), origin_.text()};
}

void FlowCase::report_divergence(const DivergedError& error) {
  constexpr std::size_t listed = 50;
  const auto cells = iteration_.worst_cells(listed);
  std::string table =
      "# Flow: " + origin_.text() +
      "\n# cells whose density changes fastest, worst first; 1e300: the residual is not a number\n"
      "cell,x,y,z,change\n";
  for (const auto& [id, at, change] : cells)
    table += fmt::format("{},{:.9g},{:.9g},{:.9g},{:.6g}\n", id, at.x, at.y, at.z, change);
  message_ = fmt::format("{}; worst: {}", error.what(),
                         named(std::span(cells).first(std::min(cells.size(), named_in_message))));
  spdlog::error("diverged: {}", message_);
  comm_.on_root([&] { replace_file_with(folder_ + "/worst_cells.csv", table); });
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
  out.steady_wall_s = comm_.max(steady_wall_);
  out.steady_cpu_s = comm_.sum(steady_cpu_);
  const auto &writing = checkpoints_.writing(), &reading = checkpoints_.reading();
  out.checkpoints = writing.times;
  out.checkpoint_wall_s = comm_.max(writing.wall);
  out.checkpoint_cpu_s = comm_.sum(writing.cpu);
  out.restart_wall_s = comm_.max(reading.wall);
  out.restart_cpu_s = comm_.sum(reading.cpu);
  out.iterations = iteration_.iterations();
  const auto iterations = static_cast<Real>(std::max<GlobalIndex>(out.iterations, 1));
  out.core_us_per_cell_iteration = 1e6 * out.cpu_s / (cells * iterations);
  out.bytes_per_cell = comm_.sum(static_cast<Real>(iteration_.bytes())) / cells;
  out.mesh_bytes_per_cell = setup_.memory.arrays / cells;
  out.reading_bytes_per_cell = setup_.memory.peak / cells;
  out.peak_bytes_per_cell = comm_.sum(peak_resident_bytes()) / cells;
  out.busiest_rank_bytes = comm_.max(peak_resident_bytes());
  const auto traffic = iteration_.halo_traffic();
  const Real owned = setup_.domain.owned_cells,
             ghosts = setup_.domain.total_cells - setup_.domain.owned_cells;
  out.halo_fraction = comm_.max(traffic.wait_seconds) / out.wall_s;
  out.halo_bytes_per_iteration = comm_.sum(static_cast<Real>(traffic.bytes)) / iterations;
  out.most_messages_per_iteration = comm_.max(static_cast<Real>(traffic.messages)) / iterations;
  out.ghost_fraction = comm_.sum(ghosts) / cells;
  out.load_imbalance = comm_.max(owned) * comm_.size() / cells - 1;
  return out;
}

Result FlowCase::result(RunStatus end, std::span<const TableRow> derivatives) const {
  Result out;
  out.status = status_of(end);
  out.not_reached = shortfalls_;
  out.message = message_;
  if (out.status == RunStatus::unconverged)
    out.message += fmt::format("{}{}", message_.empty() ? "" : "; ", fmt::join(shortfalls_, "; "));
  out.title = settings().title;
  out.verb = verb_;
  out.case_text = resolved_case(settings());
  out.motion_table_hash = setup_.motion_table_hash;
  out.mesh = setup_.mesh;
  out.configuration = configuration_result(setup_);
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
  for (const auto& row : derivatives)
    out.derivatives[row.name] = {row.value.value, row.value.uncertainty, row.method, row.converged,
                                 row.parts};
  if (!derivatives.empty()) out.uncertainty = uncertainty_scope(derivatives);
  out.performance = performance();
  out.provenance = provenance(comm_.size());
  return out;
}

bool FlowCase::keeps_result_of_before(RunStatus end) const {
  return holds_result_ && !is_finished(end);
}

void FlowCase::announce(RunStatus status, std::string message) const {
  if (keeps_result_of_before(status)) return;
  Result out = result(status);
  out.message = std::move(message);
  out.forces.clear();
  comm_.on_root([&] { write_result(folder_ + "/result.json", out); });
}

void FlowCase::write(const Result& result) const {
  if (keeps_result_of_before(result.status)) return;
  if (result.status != RunStatus::interrupted) write_pictures(folder_, setup_, iteration_, origin_, comm_);
  comm_.on_root([&] {
    replace_file_with(fmt::format("{}/{}", folder_, resolved_case_name),
                      fmt::format("# {}\n{}", origin_.text(), result.case_text));
    write_result(folder_ + "/result.json", result);
    if (is_finished(result.status)) run_folder_->remove_stale(checkpoints_.restart() != nullptr);
  });
}

void FlowCase::print(const Result& result, std::span<const TableRow> derivatives) const {
  if (!spdlog::should_log(spdlog::level::info)) return;
  const auto loads = coefficients(steady_report_.total, settings());
  if (!derivatives.empty())
    print_out(derivative_table(derivatives, table_head(result.status, derivatives)) + "\n");
  print_out(fmt::format("Steady: CA {:.6f}  CN {:+.6f}  Cm {:+.6f} about x = {:g}\n", loads.CA, loads.CN,
                        loads.Cm, settings().reference.moment_center.x));
  const auto& p = result.performance;
  spdlog::info(
      "{} wall, {:.1f} s of processor, {} iterations, {:.3f} us of core time per cell and iteration, "
      "{:.0f} bytes per cell, {:.1f} % waiting for halos, {:.1f} % writing {} checkpoint{}",
      duration_text(p.wall_s), p.cpu_s, p.iterations, p.core_us_per_cell_iteration, p.bytes_per_cell,
      100 * p.halo_fraction, 100 * p.checkpoint_wall_s / p.wall_s, p.checkpoints,
      p.checkpoints == 1 ? "" : "s");
}

void FlowCase::print_end(const Result& result) const {
  if (result.status == RunStatus::unconverged)
    spdlog::warn("not converged: {}; written to {}", result.message, folder_);
  else if (keeps_result_of_before(result.status))
    spdlog::warn("{}; the finished result of before is left in {}", to_string(result.status), folder_);
  else
    spdlog::info("{}; written to {}", to_string(result.status), folder_);
}

}  // namespace alphadot
