// What derivatives can begin from.
#pragma once

#include "app/flow_case.hpp"

namespace alphadot {

/// Derivatives are about a steady state, which a checkpoint made in a motion no longer has: throws
/// InputError.
inline void check_steady_restart(const FlowCase& flow) {
  const auto* restart = flow.checkpoints().restart();
  if (restart && restart->phase == "motion")
    throw InputError(
        flow.folder(), 0, "the checkpoint to go on from was made in a motion",
        "name that of the steady state with --restart FILE, or begin in another folder with --out DIR");
}

}  // namespace alphadot
