// The verb "frequency": stability derivatives at finite frequency from linear solves.
#include <algorithm>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "analysis/frequency_table.hpp"
#include "analysis/rational_fit.hpp"
#include "app/case_run.hpp"
#include "app/kept_solutions.hpp"
#include "app/load_case.hpp"
#include "app/stop.hpp"
#include "app/verbs.hpp"
#include "core/log.hpp"
#include "core/timer.hpp"
#include "io/files.hpp"

namespace alphadot {

namespace {

/// Into rational_fit.csv; too few frequencies for a fit leave none.
void write_fits(std::span<const VariableFit> fits, const TableHead& head, const std::string& folder) {
  if (fits.empty()) return;
  for (const auto& [variable, coefficients, fit] : fits)
    spdlog::info(
        "rational fit of {}: {} states, off by {:.2g} % of the response, {:.2g} % between frequencies",
        name(variable), fit.states(), 100 * *std::ranges::max_element(fit.error),
        100 * *std::ranges::max_element(fit.error_between));
  replace_file_with(folder + "/rational_fit.csv", rational_fit_csv(fits, head));
}

}  // namespace

RunStatus frequency_verb(const CaseArguments& arguments, std::vector<Real> frequencies, bool with_gusts,
                         const Communicator& comm) {
  std::ranges::sort(frequencies);
  frequencies.erase(std::unique(frequencies.begin(), frequencies.end()), frequencies.end());
  const SignalListener signals;
  CaseRun run(load_case(arguments.case_file, arguments.overrides, comm), arguments, "frequency", comm);
  run.check_not_in_motion();
  auto& record = run.record();
  record.announce();
  std::vector<FrequencyRow> rows;
  Real linear_cpu = not_measured;
  const RunStatus status = run.carry_out([&](RunStatus marched) {
    const Timer timer;
    run.progress().begin_phase("linear solves");
    Oscillations oscillations = kept_oscillations(run);
    const LinearSolves solves(run, [&] { keep(run, oscillations); });
    const bool is_done =
        solve_oscillations(run.flow(), frequencies, with_gusts, oscillations, solves.observer());
    if (is_done) {
      std::vector<std::string> shortfalls;
      rows = frequency_rows(run.flow(), frequencies, with_gusts, oscillations, shortfalls);
      for (auto& shortfall : shortfalls) record.fall_short(std::move(shortfall));
    }
    linear_cpu = timer.cpu();
    return is_done ? marched : RunStatus::interrupted;
  });
  return run.conclude(status, table_rows(rows), linear_cpu, "linear solves", "frequency.csv",
                      [&](const TableHead& head) {
                        write_fits(rational_fits(rows), head, record.folder());
                        return frequency_csv(rows, head);
                      });
}

}  // namespace alphadot
