// Messages to the person at the terminal: written by the root rank only.
#pragma once

#include <spdlog/spdlog.h>

namespace alphadot {

/// Sets up the log: plain lines on standard error; silent on ranks other than the root.
void set_up_log(bool is_root, bool quiet);

}  // namespace alphadot
