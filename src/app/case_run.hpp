// A run of a case in a folder: the flow with its checkpoints, its progress and its record.
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "app/checkpoints.hpp"
#include "app/flow_checkpoint.hpp"
#include "app/progress.hpp"
#include "app/run_folder.hpp"
#include "app/run_record.hpp"
#include "app/verbs.hpp"
#include "core/timer.hpp"
#include "derivatives/flow_case.hpp"

namespace alphadot {

class CaseRun {
 public:
  /// Makes and locks the run's folder, reads the mesh, chooses the checkpoint to begin from. Collective.
  /// Throws InputError on every rank.
  CaseRun(const Case& settings, const RunOptions& options, const std::string& verb, const Communicator& comm);
  CaseRun(const CaseRun&) = delete;
  CaseRun& operator=(const CaseRun&) = delete;

  FlowCase& flow() { return flow_; }
  const FlowCase& flow() const { return flow_; }
  const Case& settings() const { return flow_.settings(); }
  const Communicator& communicator() const { return flow_.communicator(); }
  Checkpoints& checkpoints() { return checkpoints_; }
  const Checkpoints& checkpoints() const { return checkpoints_; }
  FlowCheckpoint& contents() { return contents_; }
  const FlowCheckpoint& contents() const { return contents_; }
  RunRecord& record() { return record_; }
  const RunRecord& record() const { return record_; }
  Progress& progress() { return progress_; }

  /// Marches to the steady state with progress lines and checkpoints, from where a restart begins, and then,
  /// unless that was interrupted, does `about_it`; it is given the status of the march and returns that of
  /// the whole. A flow that diverges, in either, is reported. Collective.
  RunStatus carry_out(const std::function<RunStatus(RunStatus)>& about_it);
  /// Ends a run of linear solves, `solves` by name, which took `linear_cpu` on this rank: the rows and, where
  /// there are any, the file `table` of the text that `csv` makes below its head; result, report, status.
  /// Collective.
  RunStatus conclude(RunStatus end, std::span<const TableRow> rows, Real linear_cpu, std::string_view solves,
                     const std::string& table, const std::function<std::string(const TableHead&)>& csv);
  /// Derivatives are about a steady state, which a checkpoint made in a motion no longer has: throws
  /// InputError.
  void check_not_in_motion() const;

 private:
  /// Nothing is left to do when a restart begins in the motion.
  RunStatus march();

  Timer since_start_;
  std::unique_ptr<RunFolder> run_folder_;  ///< on the root, until the record has it
  std::string folder_;
  FlowCase flow_;
  Checkpoints checkpoints_;
  RunRecord record_;
  FlowCheckpoint contents_;
  Progress progress_;
};

}  // namespace alphadot
