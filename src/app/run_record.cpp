#include "app/run_record.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <utility>

#include "app/configuration_view.hpp"
#include "app/pictures.hpp"
#include "app/progress.hpp"
#include "case_file/case_file.hpp"
#include "case_file/history_info.hpp"
#include "core/csv.hpp"
#include "core/log.hpp"
#include "core/memory.hpp"
#include "derivatives/axial_estimates.hpp"
#include "derivatives/loads.hpp"
#include "derivatives/panel_table.hpp"
#include "derivatives/part.hpp"
#include "io/files.hpp"

namespace alphadot {

namespace {

/// Begins what was not reached in the message of a checkpoint.
const std::string not_reached_mark = "\nnot reached: ";

}  // namespace

NamedValues named(const Coefficients& coefficients) {
  NamedValues out;
  for (int i = 0; i < Coefficients::size(); ++i)
    out.emplace_back(std::string(coefficient_names[static_cast<std::size_t>(i)]), coefficients[i]);
  return out;
}

std::vector<std::string> excluded_patches(const Setup& setup) {
  std::vector<std::string> out;
  for (std::size_t patch = 0; patch < setup.patch_kinds.size(); ++patch) {
    const auto kind = setup.patch_kinds[patch];
    if (kind == BoundaryKind::jet || kind == BoundaryKind::sting)
      out.push_back(setup.domain.patch_names[patch]);
  }
  return out;
}

RunRecord::RunRecord(const FlowCase& flow, const Checkpoints& checkpoints, std::unique_ptr<RunFolder> folder,
                     std::string path, std::string verb, const Timer& since_start)
    : flow_(flow),
      checkpoints_(checkpoints),
      comm_(flow.communicator()),
      since_start_(since_start),
      folder_(std::move(folder)),
      path_(std::move(path)),
      verb_(std::move(verb)),
      holds_result_(comm_.any(folder_ && folder_->holds_result())),
      origin_(history_info(flow.settings(), flow.setup().mesh.hash).origin()) {}

void RunRecord::add_steady_time(const Timer& timer) {
  steady_wall_ = timer.wall();
  steady_cpu_ = timer.cpu();
}

std::string RunRecord::kept_message() const {
  std::string out = message();
  for (const auto& shortfall : shortfalls_) out += not_reached_mark + shortfall;
  return out;
}

void RunRecord::take_up(std::string kept_message) {
  for (std::size_t at; (at = kept_message.rfind(not_reached_mark)) != std::string::npos;
       kept_message.resize(at))
    shortfalls_.insert(shortfalls_.begin(), kept_message.substr(at + not_reached_mark.size()));
  message_ = std::move(kept_message);
}

void RunRecord::fall_short(std::string of_what) {
  spdlog::warn("not reached: {}", of_what);
  shortfalls_.push_back(std::move(of_what));
}

RunStatus RunRecord::status_of(RunStatus end) const {
  const bool is_good = end == RunStatus::converged || end == RunStatus::completed;
  return is_good && !shortfalls_.empty() ? RunStatus::unconverged : end;
}

TableHead RunRecord::table_head(RunStatus end, std::span<const TableRow> rows) const {
  std::string status = to_string(status_of(end));
  if (!shortfalls_.empty()) status += fmt::format(": {}", fmt::join(shortfalls_, "; "));
  return {flow_.settings().reference, status, uncertainty_scope(rows), origin_.text()};
}

void RunRecord::report_divergence(const DivergedError& error) {
  constexpr std::size_t listed = 50;
  const auto cells = flow_.iteration().worst_cells(listed);
  std::string table =
      csv_comment(
          "Flow: " + origin_.text() +
          "\ncells whose density changes fastest, worst first; 1e300: the residual is not a number\n") +
      "cell,x,y,z,change\n";
  for (const auto& [id, at, change] : cells)
    table +=
        csv_line(std::array{fmt::format("{}", id), fmt::format("{:.9g}", at.x), fmt::format("{:.9g}", at.y),
                            fmt::format("{:.9g}", at.z), fmt::format("{:.6g}", change)});
  message_ = fmt::format("{}; worst: {}", error.what(), named(std::span<const SuspectCell>(cells)));
  spdlog::error("diverged: {}", message_);
  comm_.on_root([&] { replace_file_with(path_ + "/worst_cells.csv", table); });
}

PerformanceResult RunRecord::performance() const {
  PerformanceResult out;
  const Real cells = static_cast<Real>(flow_.setup().mesh.cells);
  out.wall_s = comm_.max(since_start_.wall());
  out.cpu_s = comm_.sum(since_start_.cpu());
  out.steady_wall_s = comm_.max(steady_wall_);
  out.steady_cpu_s = comm_.sum(steady_cpu_);
  const auto &writing = checkpoints_.writing(), &reading = checkpoints_.reading();
  out.checkpoints = writing.times;
  out.checkpoint_wall_s = comm_.max(writing.wall);
  out.checkpoint_cpu_s = comm_.sum(writing.cpu);
  out.restart_wall_s = comm_.max(reading.wall);
  out.restart_cpu_s = comm_.sum(reading.cpu);
  out.iterations = flow_.iteration().iterations();
  const auto iterations = static_cast<Real>(std::max<GlobalIndex>(out.iterations, 1));
  out.core_us_per_cell_iteration = 1e6 * out.cpu_s / (cells * iterations);
  out.bytes_per_cell = comm_.sum(static_cast<Real>(flow_.iteration().bytes())) / cells;
  out.mesh_bytes_per_cell = flow_.setup().memory.arrays / cells;
  out.reading_bytes_per_cell = flow_.setup().memory.peak / cells;
  out.peak_bytes_per_cell = comm_.sum(peak_resident_bytes()) / cells;
  out.busiest_rank_bytes = comm_.max(peak_resident_bytes());
  const auto traffic = flow_.iteration().halo_traffic();
  const Real owned = flow_.setup().domain.owned_cells,
             ghosts = flow_.setup().domain.total_cells - flow_.setup().domain.owned_cells;
  out.halo_fraction = comm_.max(traffic.wait_seconds) / out.wall_s;
  out.halo_bytes_per_iteration = comm_.sum(static_cast<Real>(traffic.bytes)) / iterations;
  out.most_messages_per_iteration = comm_.max(static_cast<Real>(traffic.messages)) / iterations;
  out.ghost_fraction = comm_.sum(ghosts) / cells;
  out.load_imbalance = comm_.max(owned) * comm_.size() / cells - 1;
  return out;
}

Result RunRecord::result(RunStatus end, std::span<const TableRow> derivatives) const {
  Result out;
  out.status = status_of(end);
  out.not_reached = shortfalls_;
  out.message = message();
  if (out.status == RunStatus::unconverged)
    out.message += fmt::format("{}{}", message().empty() ? "" : "; ", fmt::join(shortfalls_, "; "));
  out.title = flow_.settings().title;
  out.verb = verb_;
  out.case_text = resolved_case(flow_.settings());
  out.motion_table_hash = flow_.setup().motion_table_hash;
  out.mesh = flow_.setup().mesh;
  out.configuration = configuration_result(flow_.setup());
  out.reference = flow_.settings().reference;
  out.freestream = flow_.settings().freestream;
  out.rate = "length / (2 V)";
  out.axes = "body: x aft, z up for forces; moments nose up and nose to starboard positive";
  out.forces = named(coefficients(flow_.steady_report().total, flow_.settings()));
  const auto& patches = flow_.setup().domain.patch_names;
  const auto& loads = flow_.steady_report().loads;
  if (!loads.empty())
    for (const auto& [name, walls] : components_of(flow_.settings())) {
      const Load load = Part(walls, patches).of(loads, {});
      out.components[name] = named(coefficients(load, flow_.settings()));
      if (flow_.settings().reference.half_model)
        out.one_side[name] = named(coefficients(load, of_one_side(flow_.settings())));
    }
  if (!loads.empty())
    out.panels = steady_panel_loads(flow_.settings(), flow_.settings().controls, loads, patches);
  out.excluded = excluded_patches(flow_.setup());
  for (const auto& one : axial_estimates(flow_.setup().configuration, patches, flow_.settings()))
    out.estimates[one.name] = {one.CA, one.source};
  for (const auto& row : derivatives)
    out.derivatives[row.name] = {row.value.value, row.value.uncertainty, row.method, row.converged,
                                 row.parts};
  if (!derivatives.empty()) out.uncertainty = uncertainty_scope(derivatives);
  out.performance = performance();
  out.provenance = provenance(comm_.size());
  return out;
}

bool RunRecord::keeps_result_of_before(RunStatus end) const {
  return holds_result_ && !is_finished(end);
}

void RunRecord::announce(RunStatus status, std::string message) const {
  if (keeps_result_of_before(status)) return;
  Result out = result(status);
  out.message = std::move(message);
  out.forces.clear();
  comm_.on_root([&] { write_result(path_ + "/result.json", out); });
}

void RunRecord::write(const Result& result, const FieldsOnFaces& more) const {
  if (keeps_result_of_before(result.status)) return;
  if (result.status != RunStatus::interrupted)
    write_pictures(path_, flow_.setup(), flow_.iteration(), more, origin_, comm_);
  comm_.on_root([&] {
    replace_file_with(fmt::format("{}/{}", path_, resolved_case_name),
                      fmt::format("# {}\n{}", origin_.text(), result.case_text));
    write_result(path_ + "/result.json", result);
    if (is_finished(result.status)) folder_->remove_stale(checkpoints_.restart() != nullptr);
  });
}

void RunRecord::print(const Result& result, std::span<const TableRow> derivatives) const {
  if (!spdlog::should_log(spdlog::level::info)) return;
  const auto loads = coefficients(flow_.steady_report().total, flow_.settings());
  if (!derivatives.empty())
    print_out(derivative_table(derivatives, table_head(result.status, derivatives)) + "\n");
  print_out(fmt::format("Steady: CA {:.6f}  CN {:+.6f}  Cm {:+.6f} about x = {:g}\n", loads.CA, loads.CN,
                        loads.Cm, flow_.settings().reference.moment_center.x));
  for (const auto& [name, estimate] : result.estimates)
    print_out(
        fmt::format("Not in it: CA of the {} {:+.6f}, estimated ({})\n", name, estimate.CA, estimate.source));
  const auto& p = result.performance;
  spdlog::info(
      "{} wall, {:.1f} s of processor, {} iterations, {:.3f} us of core time per cell and iteration, "
      "{:.0f} bytes per cell, {:.1f} % waiting for halos, {:.1f} % writing {} checkpoint{}",
      duration_text(p.wall_s), p.cpu_s, p.iterations, p.core_us_per_cell_iteration, p.bytes_per_cell,
      100 * p.halo_fraction, 100 * p.checkpoint_wall_s / p.wall_s, p.checkpoints,
      p.checkpoints == 1 ? "" : "s");
}

void RunRecord::print_end(const Result& result) const {
  if (result.status == RunStatus::unconverged)
    spdlog::warn("not converged: {}; written to {}", result.message, path_);
  else if (keeps_result_of_before(result.status))
    spdlog::warn("{}; the finished result of before is left in {}", to_string(result.status), path_);
  else
    spdlog::info("{}; written to {}", to_string(result.status), path_);
}

}  // namespace alphadot
