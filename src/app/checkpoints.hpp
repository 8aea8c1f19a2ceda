// The checkpoints of one run: when they are due, writing them, and the one a restart begins from.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/timer.hpp"
#include "derivatives/setup.hpp"
#include "io/checkpoint.hpp"
#include "io/checkpoint_folder.hpp"
#include "march/implicit_iteration.hpp"

namespace alphadot {

/// What the run has been asked for and not yet done.
struct Request {
  bool save = false, stop = false;
};

class Checkpoints {
 public:
  /// Collective. A file "stop" in `stop_folder` ends the run; `since_start` is its clock. The references must
  /// outlive the object.
  Checkpoints(const Setup& setup, std::string folder, std::string stop_folder, const Timer& since_start,
              const Communicator& comm);

  /// Leaves checkpoints of another flow in the folder alone.
  void leave_others_alone();

  /// Chooses where the run begins: `file`, or with an empty name the newest whole checkpoint of the folder;
  /// without any there, the beginning. Collective. Throws InputError on every rank when there is no whole
  /// one, or when it belongs to another mesh or a contradicting case.
  void begin_from(const std::string& file);
  /// The head of the checkpoint that the run begins from, if any.
  const CheckpointHead* restart() const { return restart_ ? &restart_->head : nullptr; }
  /// The case that it was made with.
  const Case& case_before() const { return case_before_; }
  /// Its states. Collective.
  void read(const std::vector<CheckpointField>& fields);

  /// Signals, stop file and clock of all ranks, for the all-reduces of an iteration. Refers to this object.
  Reduction reduction();
  /// To be called after each iteration or step: with what the sums told up to now. `interval_is_over`, the
  /// same on all ranks, asks for a checkpoint as well. A request stays until it is fulfilled: by save(), or
  /// by the end.
  Request request(bool interval_is_over);
  /// Writes a checkpoint and tells of it. Collective. When it cannot be written: InputError on every rank, or
  /// a warning, as the case says.
  void save(const CheckpointHead& head, const std::vector<CheckpointField>& fields);
  /// Why request() is for the end.
  const std::string& stop_reason() const { return stop_reason_; }

  /// What the checkpoints that were written have cost this rank, and what beginning from one has.
  const TimeSpent& writing() const { return writing_; }
  const TimeSpent& reading() const { return reading_; }

 private:
  std::vector<Real> asked_here();
  void hear(std::span<const Real> asked);
  bool found_stop_file();
  bool wall_limit_is_near() const;

  const Setup& setup_;
  std::string folder_, stop_folder_;
  const Timer& since_start_;
  const Communicator& comm_;
  CheckpointFile file_;
  std::optional<CheckpointFolder> in_folder_;  ///< on the root
  std::optional<RestartPoint> restart_;
  Case case_before_;
  Request request_;
  std::string stop_reason_;
  std::string latest_;  ///< file name of the last whole checkpoint, on the root
  Real last_asked_, longest_step_ = 0, last_save_, last_cost_ = 0, last_look_ = -1;  ///< seconds
  TimeSpent writing_, reading_;
};

}  // namespace alphadot
