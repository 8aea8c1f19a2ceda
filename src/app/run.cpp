// The verb "run": steady state, motion, derivatives, files.
#include <fmt/format.h>

#include <cmath>

#include "analysis/table.hpp"
#include "app/extraction.hpp"
#include "app/flow_case.hpp"
#include "app/loads.hpp"
#include "app/progress.hpp"
#include "core/error.hpp"
#include "core/log.hpp"
#include "io/history.hpp"
#include "solver/dual_time.hpp"

namespace alphadot {

namespace {

void append(History::Row& row, const std::string& group, const Coefficients& c) {
  for (const auto& [name, value] : named(c)) row.emplace_back(group + "/" + name, value);
}

History::Row history_row(const StepReport& step, const FlowCase& flow) {
  const Case& settings = flow.settings();
  History::Row row{
      {"step", step.step},
      {"time", step.time},
      {"t_star", flow.motion().reduced_time(step.time)},
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
  const auto& setup = flow.setup();
  for (std::size_t patch = 0; patch < setup.patch_kinds.size(); ++patch)
    if (setup.patch_kinds[patch] == BoundaryKind::wall)
      append(row, setup.domain.patch_names[patch], coefficients(step.report.loads[patch], settings));
  return row;
}

RunStatus follow_motion(FlowCase& flow, History& history) {
  const Case& settings = flow.settings();
  const int steps =
      static_cast<int>(std::lround(settings.unsteady.cycles * settings.unsteady.steps_per_cycle));
  const Real time_step = flow.motion().period() / settings.unsteady.steps_per_cycle;
  DualTime dual_time(flow.iteration(), flow.motion(), settings.motion.axis_point, time_step,
                     flow.steady_report().total);
  const InnerTolerance tolerance{settings.unsteady.inner_tolerance * settings.motion.reduced_frequency,
                                 settings.motion.amplitude * radians_per_degree, settings.unsteady.max_inner};
  ProgressLines lines(settings);
  while (dual_time.step() < steps) {
    const auto step = dual_time.advance(tolerance);
    lines.show(step, steps);
    history.append(history_row(step, flow));
  }
  return RunStatus::completed;
}

}  // namespace

RunStatus run_verb(const CaseArguments& arguments, const Communicator& comm) {
  FlowCase flow(arguments, comm);
  History history(history_info(flow.settings(), flow.setup().mesh.hash));
  Extraction extraction;
  RunStatus status = RunStatus::error;
  try {
    status = flow.march();
    if (status != RunStatus::interrupted && flow.settings().motion.kind != MotionKind::none) {
      status = follow_motion(flow, history);
      extraction = extract_derivatives(history);
    }
  } catch (const DivergedError& error) {
    status = RunStatus::diverged;
    flow.set_message(error.what());
    spdlog::error("diverged: {}", error.what());
  }

  if (history.steps() > 0) comm.on_root([&] { write_history(flow.folder(), history); });
  const auto rows = rows_of(extraction.derivatives, extraction.method);
  Result result = flow.result(status);
  for (const auto& row : rows)
    result.derivatives[row.name] = {row.value.value, row.value.uncertainty, row.method};
  flow.write(result);
  if (!rows.empty()) spdlog::info("\n{}", derivative_table(rows, flow.settings().reference));
  flow.print(result);
  return status;
}

}  // namespace alphadot
