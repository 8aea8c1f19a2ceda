// The folder of a run: whose results it holds, and what a new run may do to them.
#pragma once

#include <map>
#include <string>

#include "derivatives/setup.hpp"
#include "io/files.hpp"

namespace alphadot {

/// One folder holds the results of one flow and one verb. What stands there finished stays until the result
/// of a new run stands; then whatever that run has not replaced goes. For the root.
class RunFolder {
 public:
  /// Makes the folder and locks it for the life of the object. Throws InputError.
  explicit RunFolder(std::string folder);

  /// Refuses a run of `verb` that would replace one of its inputs; and, unless it may overwrite, one beside
  /// results or checkpoints of another flow, verb or unknown origin. Throws InputError with what differs and
  /// what to do.
  void admit(const Setup& setup, const std::string& verb, bool may_overwrite);
  /// Whether a result of a run that came to its end stands here.
  bool holds_result() const { return holds_result_; }
  /// Whether results or checkpoints of another flow, to be overwritten, do.
  bool holds_other() const { return holds_other_; }

  /// Removes what the run has not replaced, now that its result stands; checkpoints of the same flow stay,
  /// and with `goes_on` the record of the steady march.
  void remove_stale(bool goes_on) const;

 private:
  void refuse_inputs(const Setup& setup) const;

  std::string folder_;
  FolderLock lock_;
  bool holds_result_ = false, holds_other_ = false;
  std::map<std::string, std::string> before_;  ///< names of files of runs, and marks that change with them
};

/// The case of a run with every default filled in.
inline constexpr const char* resolved_case_name = "resolved_case.toml";

}  // namespace alphadot
