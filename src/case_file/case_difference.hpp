// May a run with one case go on from the state of another, or stand where its results are?
#pragma once

#include <string>
#include <vector>

#include "derivatives/case.hpp"

namespace alphadot {

/// What two cases have to share: a steady flow (not how it is marched to); also the motion about it; also how
/// that is marched through, steady flow included.
enum class Shared { flow, motion, steps };

struct KeyDifference {
  std::string key, before, now;
};

/// The keys in which two cases contradict each other. Free to differ are always title, output, checkpoint and
/// cycles, and the files of mesh and motion, whose content has to be compared.
std::vector<KeyDifference> differences(const Case& before, const Case& now, Shared shared);

}  // namespace alphadot
