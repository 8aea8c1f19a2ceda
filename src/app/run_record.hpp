// What a run says of itself: how it ended, what was not reached, what it found and what it cost.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "analysis/table.hpp"
#include "app/checkpoints.hpp"
#include "app/run_folder.hpp"
#include "core/error.hpp"
#include "core/timer.hpp"
#include "derivatives/flow_case.hpp"
#include "derivatives/linear_derivatives.hpp"
#include "io/result.hpp"

namespace alphadot {

class RunRecord {
 public:
  /// Of a run of `verb` about `flow` that writes into `folder`, which the root alone has. The references must
  /// outlive the object. Collective.
  RunRecord(const FlowCase& flow, const Checkpoints& checkpoints, std::unique_ptr<RunFolder> folder,
            std::string path, std::string verb, const Timer& since_start);

  const std::string& folder() const { return path_; }
  /// Why the run ended as it did, or what the steady march says about the case.
  const std::string& message() const { return message_.empty() ? flow_.remark() : message_; }
  void set_message(std::string message) { message_ = std::move(message); }
  /// Something that the case asked for was not reached: the run cannot end as converged or completed any
  /// more, and all that it writes says so.
  void fall_short(std::string of_what);
  const std::vector<std::string>& shortfalls() const { return shortfalls_; }
  /// Message and shortfalls as a text to be kept in a checkpoint, and back.
  std::string kept_message() const;
  void take_up(std::string kept_message);
  /// The status with which a run that came to this end ends, shortfalls included.
  RunStatus status_of(RunStatus end) const;
  /// Which flow the numbers are of, and what computes them.
  const Origin& origin() const { return origin_; }
  /// What stands above the tables of a run that came to this end.
  TableHead table_head(RunStatus end, std::span<const TableRow> rows) const;
  /// What the march to the steady flow took on this rank.
  void add_steady_time(const Timer& timer);

  /// Says where the flow went wrong: in the message of the result, in the log and in worst_cells.csv.
  /// Collective.
  void report_divergence(const DivergedError& error);

  /// Everything in result.json of a run that came to this end, with the derivatives of a table. Collective.
  Result result(RunStatus end, std::span<const TableRow> derivatives = {}) const;
  /// Whether a run that came to this end leaves a finished result of before in its place: it has none itself.
  bool keeps_result_of_before(RunStatus end) const;
  /// Whether the folder holds results or checkpoints of another flow; known on the root.
  bool holds_other() const { return folder_ && folder_->holds_other(); }
  /// Writes a result.json without results, by default what stands there when the run is killed; where there
  /// is no finished one. Collective.
  void announce(RunStatus status = RunStatus::interrupted,
                std::string message = "the run has not ended, or was killed") const;
  /// Writes pictures (but when interrupted), resolved case and result.json, and removes what is none of this
  /// run's; nothing where the result of before is kept. `more`: for the picture of the surface. Collective.
  void write(const Result& result, const FieldsOnFaces& more = {}) const;
  /// What the run has found, on standard output (unless quiet), and what it cost, in the log.
  void print(const Result& result, std::span<const TableRow> derivatives) const;
  /// The last line of the log: how the run ended, and what was not reached.
  void print_end(const Result& result) const;

 private:
  PerformanceResult performance() const;

  const FlowCase& flow_;
  const Checkpoints& checkpoints_;
  const Communicator& comm_;
  const Timer& since_start_;
  std::unique_ptr<RunFolder> folder_;  ///< on the root
  std::string path_, verb_;
  bool holds_result_;  ///< of before
  Origin origin_;
  Real steady_wall_ = not_measured, steady_cpu_ = not_measured;  // of the march on this rank
  std::string message_;
  std::vector<std::string> shortfalls_;
};

/// The six coefficients with their names.
NamedValues named(const Coefficients& coefficients);

/// Patches that the forces leave out.
std::vector<std::string> excluded_patches(const Setup& setup);

}  // namespace alphadot
