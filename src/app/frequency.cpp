// The verb "frequency": stability derivatives at finite frequency from linear solves.
#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "analysis/frequency_table.hpp"
#include "app/case_run.hpp"
#include "app/kept_solutions.hpp"
#include "app/load_case.hpp"
#include "app/stop.hpp"
#include "app/verbs.hpp"
#include "core/timer.hpp"

namespace alphadot {

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
                      [&](const TableHead& head) { return frequency_csv(rows, head); });
}

}  // namespace alphadot
