// Small helpers about TOML as text.
#pragma once

#include <string>
#include <string_view>

#include "core/error.hpp"

namespace alphadot {

/// `text` as a TOML string on one line, in quotes.
std::string toml_string(std::string_view text);

/// What makes `text` unsafe to hand to the TOML library (toml++ 3.3), with its line; line 0 when nothing
/// does.
/// - Keys of more than 16 parts: the library bounds the depth of arrays and inline tables but not that of
///   dotted keys, and destroys its tree recursively.
/// - Control characters, and outside quotes and comments those that are not ASCII: TOML has no use for them,
///   and some lead the library into code that it declares unreachable.
/// - More than 1,000 commas and opening brackets: a case has few, and each takes 16 bytes in an array of the
///   library.
/// - Quotes where none can open, and multi-line text: without them one pass over each line is exact.
Problem unsafe_line(std::string_view text);

}  // namespace alphadot
