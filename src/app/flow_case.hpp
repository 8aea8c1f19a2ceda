// A case set up for computing: what the verbs that solve the flow have in common.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "analysis/coefficients.hpp"
#include "app/checkpoints.hpp"
#include "app/progress.hpp"
#include "app/run_folder.hpp"
#include "app/setup.hpp"
#include "app/verbs.hpp"
#include "core/error.hpp"
#include "core/timer.hpp"
#include "io/result.hpp"
#include "march/steady.hpp"
#include "march/treatment.hpp"

namespace alphadot {

/// A steady residual that has dropped by fewer decades leaves more in derivatives than their linear solves.
inline constexpr Real deep_steady_orders = 6;

/// Mesh, solver and steady flow of one case on this rank.
class FlowCase {
 public:
  /// Makes and locks the run's folder, reads the mesh, chooses the checkpoint to begin from. Collective.
  /// Throws InputError on every rank.
  FlowCase(const Case& settings, const RunOptions& options, std::string verb, const Communicator& comm);

  const Case& settings() const { return setup_.settings; }
  const Setup& setup() const { return setup_; }
  const Communicator& communicator() const { return comm_; }
  const std::string& folder() const { return folder_; }
  ImplicitIteration& iteration() { return iteration_; }
  const Motion& motion() const { return motion_; }
  const FlowReport& steady_report() const { return steady_report_; }
  /// Decades that the residual of the steady flow has dropped, with the limiter free.
  Real steady_orders() const { return steady_orders_; }

  Conditions<Real> conditions() const;
  /// The case's way to let the motion enter the equations; moves this case's mesh. Collective.
  std::unique_ptr<Treatment> treatment(Real time_step);
  /// Marches to the steady state with progress lines and checkpoints, from where a restart begins; nothing is
  /// left to do when it begins in the motion. A march that does not reach its tolerance falls short. Throws
  /// DivergedError.
  RunStatus march();

  Checkpoints& checkpoints() { return checkpoints_; }
  const Checkpoints& checkpoints() const { return checkpoints_; }
  Progress& progress() { return progress_; }
  /// Writes a checkpoint of the flow and of `others`, fields of the march that the head belongs to.
  void save(const CheckpointHead& head, std::vector<CheckpointField> others = {});
  /// Reads the same from the checkpoint that the run begins from.
  void restore(std::vector<CheckpointField> others = {});
  /// A checkpoint's head with the loads of the steady state.
  CheckpointHead checkpoint_head(std::string phase) const;
  /// The same with all that the steady march needs to go on.
  CheckpointHead steady_head(std::string phase) const;
  /// Why the run ended as it did, for the result.
  void set_message(std::string message) { message_ = std::move(message); }
  /// Something that the case asked for was not reached: the run cannot end as converged or completed any
  /// more, and all that it writes says so.
  void fall_short(std::string of_what);
  /// Whether a linear solve for `what` dropped by the decades that the case asks for; falls short when not.
  bool reached(std::string_view what, Real relative_residual, int iterations);
  const std::vector<std::string>& shortfalls() const { return shortfalls_; }
  /// The status with which a run that came to this end ends, shortfalls included.
  RunStatus status_of(RunStatus end) const;
  /// Which flow the numbers are of, and what computes them.
  const Origin& origin() const { return origin_; }
  /// What stands above the tables of a run that came to this end.
  TableHead table_head(RunStatus end, std::span<const TableRow> rows) const;

  /// Says where the flow went wrong: in the message of the result, in the log and in worst_cells.csv.
  /// Collective.
  void report_divergence(const DivergedError& error);

  /// Everything in result.json of a run that came to this end, with the derivatives of a table. Collective.
  Result result(RunStatus end, std::span<const TableRow> derivatives = {}) const;
  /// Whether a run that came to this end leaves a finished result of before in its place: it has none itself.
  bool keeps_result_of_before(RunStatus end) const;
  /// Writes a result.json without results, by default what stands there when the run is killed; where there
  /// is no finished one. Collective.
  void announce(RunStatus status = RunStatus::interrupted,
                std::string message = "the run has not ended, or was killed") const;
  /// Writes pictures (but when interrupted), resolved case and result.json, and removes what is none of this
  /// run's; nothing where the result of before is kept. Collective.
  void write(const Result& result) const;
  /// What the run has found, on standard output (unless quiet), and what it cost, in the log.
  void print(const Result& result, std::span<const TableRow> derivatives) const;
  /// The last line of the log: how the run ended, and what was not reached.
  void print_end(const Result& result) const;

 private:
  std::vector<std::string> excluded_patches() const;
  PerformanceResult performance() const;
  /// Puts the steady loads of a checkpoint made in the motion in place.
  void restore_steady(const CheckpointHead& head);
  /// Frozen factors of the limiter as they are kept in checkpoints, or none.
  std::vector<Five<Real>> frozen_factors();

  const Communicator& comm_;
  Timer timer_;
  std::string verb_;
  std::unique_ptr<RunFolder> run_folder_;  ///< on the root
  Setup setup_;
  std::string folder_;
  bool holds_result_;  ///< of before
  Origin origin_;
  Checkpoints checkpoints_;
  Progress progress_;
  Discretization discretization_;
  Motion motion_;
  ImplicitIteration iteration_;
  SteadyState steady_state_;
  std::size_t steady_attempt_ = 0;  ///< how often the march has begun again
  FlowReport steady_report_;
  Real steady_orders_ = 0;
  Real steady_wall_ = not_measured, steady_cpu_ = not_measured;  // of the march on this rank
  std::string message_;
  std::vector<std::string> shortfalls_;
};

/// The six coefficients with their names.
NamedValues named(const Coefficients& coefficients);

}  // namespace alphadot
