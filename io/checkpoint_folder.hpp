// The checkpoints of a run's folder: checkpoint_000001.vtkhdf and so on, the highest number the newest.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "io/checkpoint.hpp"

namespace alphadot {

/// A checkpoint that a run can start from.
struct RestartPoint {
  std::string path;
  CheckpointHead head;
};

/// Whether a file's name is that of a checkpoint.
bool is_checkpoint_name(std::string_view name);

/// Numbers, finds and thins out the checkpoints of one folder. For one rank.
class CheckpointFolder {
 public:
  /// Keeps the newest `keep` checkpoints. Throws InputError when the folder cannot be read.
  CheckpointFolder(std::string folder, int keep);

  bool empty() const { return numbers_.empty(); }
  std::string next_path() const;  ///< higher than any there is
  /// Tells of a whole new checkpoint at next_path(); older ones beyond `keep` are removed. One that cannot be
  /// removed stays.
  void added();

  /// Leaves those that are there alone: they no longer count among the ones kept.
  void leave_alone() { numbers_.clear(); }

  /// The newest checkpoint that is whole, with why newer ones were not taken in `rejected`. Those stay in the
  /// folder, and no longer count among the ones kept. Throws InputError with all the reasons when none is
  /// whole.
  RestartPoint newest(std::vector<std::string>& rejected);

 private:
  std::string path_of(int number) const;

  std::string folder_;
  int keep_;
  std::vector<int> numbers_;  ///< of checkpoints believed whole, ascending
  int last_number_ = 0;       ///< ever given, rejected ones included
};

}  // namespace alphadot
