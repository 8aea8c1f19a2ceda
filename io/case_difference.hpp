// May a run with one case go on from the state of another?
#pragma once

#include <vector>

#include "core/case.hpp"
#include "core/error.hpp"

namespace alphadot {

/// The keys in which two cases contradict each other, as problems of `now.file`. Free to differ are what only
/// says how far, how exactly and where to: title, mesh file (its hash tells), output, checkpoint, steady
/// iteration, cycles and inner tolerance. From a steady state (`in_motion` false) any motion may follow.
std::vector<Problem> contradictions(const Case& before, const Case& now, bool in_motion);

}  // namespace alphadot
