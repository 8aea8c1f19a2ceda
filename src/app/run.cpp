// The verb "run": steady state, motion, derivatives, files.
#include <fmt/format.h>

#include <algorithm>

#include "analysis/table.hpp"
#include "app/case_run.hpp"
#include "app/load_case.hpp"
#include "app/stop.hpp"
#include "app/watchdog.hpp"
#include "case_file/history_info.hpp"
#include "core/error.hpp"
#include "core/log.hpp"
#include "core/timer.hpp"
#include "derivatives/extraction.hpp"
#include "derivatives/loads.hpp"
#include "derivatives/time_plan.hpp"
#include "io/history.hpp"
#include "march/dual_time.hpp"

namespace alphadot {

namespace {

void append(History::Row& row, const std::string& group, const Coefficients& c) {
  for (const auto& [name, value] : named(c)) row.emplace_back(group + "/" + name, value);
}

/// Of a body that flies freely, along axes at rest.
void append(History::Row& row, const FreeFlight& flight, const Case& settings) {
  const auto& state = flight.state();
  const auto& reference = settings.reference;
  const Real work = unit_work(settings);
  const Vec3 way = 1 / reference.length * state.position;
  const auto& [w, v] = state.attitude;
  row.insert(row.end(), {{"x", way.x},
                         {"y", way.y},
                         {"z", way.z},
                         {"e0", w},
                         {"e1", v.x},
                         {"e2", v.y},
                         {"e3", v.z},
                         {"energy", flight.body().kinetic_energy(state) / work},
                         {"work", state.work / work}});
}

/// `flight`: of a body that flies freely, else null.
History::Row history_row(const StepReport& step, const FlowCase& flow, const FreeFlight* flight) {
  const Case& settings = flow.settings();
  const Real rate = 1 / settings.unit_rate();
  const Vec3 rotation = on_turned_axes(step.attitude.rotation, step.attitude.angle);  // along body axes
  History::Row row{{"step", step.step},
                   {"time", step.time},
                   {"t_star", flow.motion().reduced_time(step.time)},
                   {"alpha", step.attitude.alpha},
                   {"beta", step.attitude.beta},
                   {"phi", -step.attitude.angle.x},
                   {"theta", step.attitude.angle.y},
                   {"psi", -step.attitude.angle.z},
                   {"p", -rate * rotation.x},
                   {"q", rate * rotation.y},
                   {"r", -rate * rotation.z},
                   {"inner_iterations", step.inner_iterations},
                   {"inner_orders", step.inner_orders},
                   {"inner_left", step.inner_left}};
  if (flight) append(row, *flight, settings);
  append(row, "total", coefficients(step.report.total, settings));
  append(row, "error", coefficients(step.error, settings));
  const auto& setup = flow.setup();
  for (std::size_t patch = 0; patch < setup.patch_kinds.size(); ++patch)
    if (setup.patch_kinds[patch] == BoundaryKind::wall)
      append(row, setup.domain.patch_names[patch], coefficients(step.report.loads[patch], settings));
  return row;
}

std::vector<CheckpointField> levels_of(DualTime& dual_time) {
  return {{"latest_level", dual_time.latest_level()}, {"level_before", dual_time.level_before()}};
}

void save(CaseRun& run, DualTime& dual_time, const FreeFlight* flight, const History& history) {
  auto head = run.contents().head("motion");
  const auto& state = dual_time.state();
  head.numbers["step"] = {static_cast<Real>(state.step)};
  head.numbers["largest"] = {state.largest_angle, state.largest_moment};
  if (flight) head.numbers["body"] = flight->numbers();
  head.history = history;
  run.contents().save(head, levels_of(dual_time));
}

void restore(const CheckpointHead& head, CaseRun& run, DualTime& dual_time, FreeFlight* flight,
             History& history) {
  run.contents().restore(levels_of(dual_time));
  const auto& numbers = head.numbers;
  dual_time.restore(
      {static_cast<int>(numbers.at("step").at(0)), numbers.at("largest").at(0), numbers.at("largest").at(1)});
  if (flight) flight->restore(numbers.at("body"));
  history = head.history;
  // The next linearisation, and the pictures, begin with ghosts and gradients of this flow.
  run.flow().iteration().evaluate(run.flow().conditions(), run.settings().space.order);
}

RunStatus follow_motion(CaseRun& run, History& history) {
  FlowCase& flow = run.flow();
  const Case& settings = flow.settings();
  const auto [time_step, steps, tolerance] = time_plan(settings, flow.motion());
  auto free_flight = settings.motion.kind == MotionKind::free ? flow.free_flight(time_step) : nullptr;
  FreeFlight* const flight = free_flight.get();
  // The loads that a free body answers are not deviations from those at the release.
  DualTime dual_time(flow.iteration(), flow.motion(), settings.motion.axis_point, time_step,
                     flight ? Load{} : flow.steady_report().total,
                     flight ? std::move(free_flight) : flow.treatment(time_step));
  const auto* restart = run.checkpoints().restart();
  flow.iteration().freeze_limiter(false);  // shocks move
  if (restart && restart->phase == "motion") restore(*restart, run, dual_time, flight, history);
  if (dual_time.step() > steps)
    throw InputError(settings.file, 0,
                     fmt::format("the checkpoint was made after step {} of the motion, which has {} steps",
                                 dual_time.step(), steps),
                     "set unsteady.cycles so that it has as many, or begin in another folder");
  // The record of a response begins with the loads before it and, after a jump, with those just after.
  if (dual_time.step() == 0 && !flow.motion().is_harmonic()) {
    history.append(history_row(dual_time.before(), flow, flight));
    if (flow.motion().starts_with_jump())
      history.append(history_row(dual_time.just_after_start(), flow, flight));
  }
  run.progress().begin_motion(history, steps);
  const Watchdog watchdog(
      settings.checkpoint.watchdog_minutes, [&] { return flow.iteration().iterations(); },
      flow.communicator());
  const int interval = settings.checkpoint.steps;
  while (dual_time.step() < steps) {
    const auto step = dual_time.advance(tolerance);
    history.append(history_row(step, flow, flight));
    run.progress().show(step, history);
    const Request request = run.checkpoints().request(interval > 0 && step.step % interval == 0);
    if (request.save || step.step == steps) save(run, dual_time, flight, history);
    if (request.stop && step.step < steps) return RunStatus::interrupted;
  }
  return RunStatus::completed;
}

/// Derivatives from the whole motion. A history that yields none is no reason to lose the rest; nor are they
/// what a free flight is asked for, which need not swing.
Extraction extract(RunRecord& record, const History& history, const Case& settings) {
  const bool flies = settings.motion.kind == MotionKind::free;
  if (settings.gust.kind != GustKind::none) return {};
  try {
    return flies ? extract_from_flight(history, settings.body) : extract_derivatives(history);
  } catch (const InputError& error) {
    if (flies)
      record.set_message(fmt::format("no frequency and damping: {}", error.what()));
    else
      record.fall_short(fmt::format("no derivatives: {}", error.what()));
    return {};
  }
}

NamedValues named(const Decay& decay) {
  return {{"k", decay.frequency.value},
          {"k_uncertainty", decay.frequency.uncertainty},
          {"damping", decay.damping.value},
          {"damping_uncertainty", decay.damping.uncertainty},
          {"mean", decay.mean.value},
          {"mean_uncertainty", decay.mean.uncertainty},
          {"rms", decay.rms},
          {"cycles", decay.cycles}};
}

void print(const Decay& decay) {
  print_out(fmt::format(
      "Free flight: k = {:.5g} ± {:.1g}, exp(-{:.4g} t*) ± {:.1g}, about {:.4g} ± {:.1g} deg, "
      "over {:.2g} cycles{}\n",
      decay.frequency.value, decay.frequency.uncertainty, decay.damping.value, decay.damping.uncertainty,
      decay.mean.value / radians_per_degree, decay.mean.uncertainty / radians_per_degree, decay.cycles,
      decay.damping.value < 0 ? ": the motion grows" : ""));
}

/// Says when inner iterations of steps that the derivatives rest on did not reach their tolerance.
void judge_steps(RunRecord& record, const History& history) {
  const auto [first, last] = fitted_rows(history);
  const auto& left = history.column("inner_left");
  std::size_t loose = 0;
  Real worst = 0;
  for (std::size_t row = first; row < last; ++row) {
    if (!(left[row] > 1)) continue;
    ++loose;
    worst = std::max(worst, left[row]);
  }
  if (loose > 0)
    record.fall_short(fmt::format(
        "the inner iterations of {} of {} time steps left up to {:.2g} times what unsteady.inner_tolerance "
        "allows",
        loose, last - first, worst));
}

}  // namespace

RunStatus run_verb(const CaseArguments& arguments, const Communicator& comm) {
  const SignalListener signals;
  CaseRun run(load_case(arguments.case_file, arguments.overrides, comm), arguments, "run", comm);
  auto& record = run.record();
  record.announce();
  const Setup& setup = run.flow().setup();
  History history(history_info(setup.settings, setup.mesh.hash, setup.motion_table_hash));
  Extraction extraction;
  Real motion_cpu = not_measured;
  const RunStatus status = run.carry_out([&](RunStatus marched) {
    if (!goes_on_in_time(run.settings())) return marched;
    const Timer timer;
    const RunStatus followed = follow_motion(run, history);
    motion_cpu = timer.cpu();
    if (followed == RunStatus::completed) {
      judge_steps(record, history);
      if (auto shortfall = response_shortfall(run.settings(), setup.configuration); !shortfall.empty())
        record.fall_short(std::move(shortfall));
      extraction = extract(record, history, run.settings());
    }
    return followed;
  });

  const auto& estimated = extraction.estimated;
  auto rows = rows_of(estimated.derivatives, extraction.method, Axes::body, estimated.parts);
  for (auto& row : rows) row.converged = record.shortfalls().empty();
  history.info.status = record.table_head(status, rows).status;
  if (history.steps() > 0 && !record.keeps_result_of_before(status))
    comm.on_root([&] { write_history(record.folder(), history); });
  Result result = record.result(status, rows);
  if (extraction.decay) result.decay = named(*extraction.decay);
  result.performance.motion_cpu_s = comm.sum(motion_cpu);
  record.write(result);
  record.print(result, rows);
  if (extraction.decay && spdlog::should_log(spdlog::level::info)) print(*extraction.decay);
  record.print_end(result);
  return result.status;
}

}  // namespace alphadot
