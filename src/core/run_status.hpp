// How a run ended, and what the shell is told.
#pragma once

#include <string>

namespace alphadot {

/// converged: a steady state, and the linear solves about it, to their tolerances. completed: a motion to its
/// end, every tolerance met on the way. unconverged: the same ends, but something that was asked for was not
/// reached. interrupted: stopped by a signal or on request. diverged: the flow became unphysical. error: bad
/// input or environment.
enum class RunStatus { converged, completed, unconverged, interrupted, diverged, error };

/// "converged", ...
inline std::string to_string(RunStatus status) {
  switch (status) {
    case RunStatus::converged:
      return "converged";
    case RunStatus::completed:
      return "completed";
    case RunStatus::unconverged:
      return "not_converged";
    case RunStatus::interrupted:
      return "interrupted";
    case RunStatus::diverged:
      return "diverged";
    case RunStatus::error:
      break;
  }
  return "error";
}

/// Whether a run that ended so came to its end, with numbers.
inline bool is_finished(RunStatus status) {
  return status == RunStatus::converged || status == RunStatus::completed || status == RunStatus::unconverged;
}

/// Exit code of the program: 0 converged or completed, 1 error, 3 interrupted, 4 diverged, 5 not converged.
/// (2 is a wrong command line.)
inline int exit_code(RunStatus status) {
  switch (status) {
    case RunStatus::converged:
    case RunStatus::completed:
      return 0;
    case RunStatus::unconverged:
      return 5;
    case RunStatus::interrupted:
      return 3;
    case RunStatus::diverged:
      return 4;
    case RunStatus::error:
      break;
  }
  return 1;
}

}  // namespace alphadot
