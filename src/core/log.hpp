// Messages to the person at the terminal: written by the root rank only.
#pragma once

#include <spdlog/spdlog.h>

#include <string>

namespace alphadot {

/// Sets up the log: plain lines on standard error; silent on ranks other than the root.
void set_up_log(bool is_root, bool quiet);

/// Prints text for the user on standard output, at once. Where nobody reads it any more it is lost, which is
/// no reason to lose a run.
void print_out(const std::string& text);

}  // namespace alphadot
