// The verb "frequency": stability derivatives at finite frequency from linear solves.
#include "app/frequency.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "analysis/frequency_table.hpp"
#include "app/flow_case.hpp"
#include "app/oscillations.hpp"
#include "app/steady_restart.hpp"
#include "app/stop.hpp"
#include "app/watchdog.hpp"
#include "core/log.hpp"
#include "core/timer.hpp"
#include "derivatives/flight_variables.hpp"
#include "derivatives/loads.hpp"
#include "io/files.hpp"

namespace alphadot {

namespace {

std::vector<Variable> variables_of(const Case& settings) {
  using enum Variable;
  if (settings.reference.half_model) return {alpha, q};
  return {alpha, q, beta, p, r};
}

/// Decades for a response at k: its part in phase with the rate is k times smaller than the other, and as
/// many decades better is it solved for, and one more.
DerivativeSettings settings_at(Real k, DerivativeSettings settings) {
  settings.orders += 1 + std::max(Real{0}, -std::log10(k));
  return settings;
}

/// Solves for all responses but those that the checkpoint has, lowest frequency first, with a checkpoint
/// after each. False when the run was stopped.
bool solve_all(FlowCase& flow, const std::vector<Real>& frequencies, Oscillations& oscillations,
               const std::function<bool()>& go_on) {
  const Case& settings = flow.settings();
  for (const Real k : frequencies) {
    FrequencySolver solver(flow.iteration(), flow.conditions(), settings_at(k, settings.derivatives), go_on);
    for (const auto variable : variables_of(settings)) {
      if (oscillations.has(variable, k)) continue;
      const auto guess = oscillations.guess(variable, k);
      FrequencyResponse response;
      if (!solver.solve(
              {fmt::format("{} at k = {:g}", name(variable), k), change_of(variable, settings.freestream),
               k * 2 * settings.freestream.mach / settings.reference.length, guess},
              response))
        return false;
      spdlog::info("k = {:<8g} {:6} {:3} iterations, linear residual {:.1e}", k, name(variable),
                   response.iterations, response.relative_residual);
      oscillations.add(variable, k, std::move(response));
      oscillations.save();
    }
  }
  return true;
}

/// The response of one part of the configuration, a row a coefficient that symmetry leaves.
void add_rows(const std::string& part, Variable variable, Real k, const std::array<Load, 2>& response,
              const std::array<Load, 2>& error, bool converged, const Case& settings,
              std::vector<FrequencyRow>& rows) {
  const Real scale = rate_scale(variable, settings);
  std::array<Coefficients, 2> values, errors;
  for (std::size_t i = 0; i < 2; ++i) {
    values[i] = coefficients(scale * response[i], settings);
    errors[i] = coefficients(scale * error[i], settings);
  }
  for (int c = 0; c < Coefficients::size(); ++c) {
    const auto name = coefficient_names[static_cast<std::size_t>(c)];
    if (settings.reference.half_model && name != "CA" && name != "CN" && name != "Cm") continue;
    rows.push_back({k,
                    part,
                    std::string(name),
                    variable,
                    {values[0][c], std::abs(errors[0][c])},
                    {values[1][c] / k, std::abs(errors[1][c]) / k},
                    converged});
  }
}

/// All rows; the run falls short for those that are not converged.
std::vector<FrequencyRow> rows_of(FlowCase& flow, const std::vector<Real>& frequencies,
                                  const Oscillations& oscillations) {
  const Case& settings = flow.settings();
  const bool is_deep = flow.steady_orders() >= deep_steady_orders;
  if (!is_deep)
    flow.fall_short(fmt::format("responses are of a flow {:.1f} decades down, and need {:g}",
                                flow.steady_orders(), deep_steady_orders));
  std::vector<FrequencyRow> rows;
  for (const Real k : frequencies)
    for (const auto variable : variables_of(settings)) {
      const auto& response = oscillations.at(variable, k);
      const bool converged = flow.reached(fmt::format("{} at k = {:g}", name(variable), k),
                                          response.relative_residual, response.iterations) &&
                             is_deep;
      add_rows("total", variable, k, response.total, response.total_error, converged, settings, rows);
      const auto& patches = flow.setup().domain.patch_names;
      for (std::size_t patch = 0; patch < response.loads[0].size(); ++patch)
        if (settings.boundary.at(patches[patch]) == BoundaryKind::wall)
          add_rows(patches[patch], variable, k, {response.loads[0][patch], response.loads[1][patch]},
                   {response.loads_error[0][patch], response.loads_error[1][patch]}, converged, settings,
                   rows);
    }
  return rows;
}

}  // namespace

RunStatus frequency_verb(const CaseArguments& arguments, std::vector<Real> frequencies,
                         const Communicator& comm) {
  std::ranges::sort(frequencies);
  const auto repeated = std::ranges::unique(frequencies);
  frequencies.erase(repeated.begin(), repeated.end());
  const SignalListener signals;
  FlowCase flow(load_case(arguments.case_file, arguments.overrides, comm), arguments, "frequency", comm);
  check_steady_restart(flow);
  flow.announce();
  RunStatus status = RunStatus::error;
  std::vector<FrequencyRow> rows;
  Real linear_cpu = not_measured;
  try {
    status = flow.march();
    const Timer timer;
    if (status != RunStatus::interrupted) {
      flow.progress().begin_phase("linear solves");
      std::atomic<GlobalIndex> linear_iterations{0};
      const Watchdog watchdog(
          flow.settings().checkpoint.watchdog_minutes, [&] { return linear_iterations.load(); }, comm);
      Oscillations oscillations(flow);
      if (solve_all(flow, frequencies, oscillations, [&] {
            ++linear_iterations;
            return !flow.checkpoints().request(false).stop;
          })) {
        rows = rows_of(flow, frequencies, oscillations);
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
  const auto derivatives = table_rows(rows);
  Result result = flow.result(status, derivatives);
  result.performance.linear_cpu_s = comm.sum(linear_cpu);
  if (!rows.empty())
    comm.on_root([&] {
      replace_file_with(flow.folder() + "/frequency.csv",
                        frequency_csv(rows, flow.table_head(result.status, derivatives)));
    });
  flow.write(result);
  flow.print(result, derivatives);
  spdlog::info("of these, steady state {:.1f} s of processor, linear solves {:.1f} s",
               result.performance.steady_cpu_s, result.performance.linear_cpu_s);
  flow.print_end(result);
  return result.status;
}

}  // namespace alphadot
