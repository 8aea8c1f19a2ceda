// From the command line to a case.
#pragma once

#include <string>
#include <vector>

#include "core/communicator.hpp"
#include "derivatives/case.hpp"

namespace alphadot {

/// Reads and checks the case file (on the root; broadcast). Collective. Throws InputError on every rank, with
/// the mistakes of the files that a faulty case names, too.
Case load_case(const std::string& path, const std::vector<std::string>& overrides, const Communicator& comm);

}  // namespace alphadot
