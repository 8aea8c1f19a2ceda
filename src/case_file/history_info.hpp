// What the history of a case refers to.
#pragma once

#include <string>

#include "derivatives/case.hpp"
#include "io/history.hpp"

namespace alphadot {

/// Of a mesh and, where there is one, a table of a motion with these hashes; the case is resolved.
HistoryInfo history_info(const Case& c, const std::string& mesh_hash,
                         const std::string& motion_table_hash = "");

}  // namespace alphadot
