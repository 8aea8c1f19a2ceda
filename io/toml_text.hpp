// Small helpers about TOML as text.
#pragma once

#include <string>
#include <string_view>

#include "core/error.hpp"

namespace alphadot {

/// `text` as a TOML string on one line, in quotes.
std::string toml_string(std::string_view text);

/// What makes `text` unsafe to hand to the TOML library, with its line; line 0 when nothing does. The library
/// bounds the depth of arrays and inline tables but not of dotted keys, and destroys its tree recursively:
/// keys of more than 16 parts are refused, and so is multi-line text, without which one pass over the quotes
/// is exact.
Problem unsafe_line(std::string_view text);

}  // namespace alphadot
