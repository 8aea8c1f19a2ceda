// Recognises files that are no mesh the readers know, so that a message can name them.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "core/error.hpp"

namespace alphadot {

/// ASCII letters alone.
std::string in_lower_case(std::string_view text);

/// What a file is by its content, and what to do with it; nothing when it may be a mesh. Where text is
/// expected, blanks and a byte order mark before it do not count; a binary mesh may begin with any number, so
/// that there only beginnings of eight bytes or more tell.
enum class Expected { text, binary };
std::optional<Problem> foreign_content(const std::string& path, std::string_view content, Expected expected);

/// The first bytes of a file, as many as are needed for that; none when it cannot be read.
std::string beginning_of(const std::string& path);

/// The same by its name, which is in lower case, or by its being a folder.
std::optional<Problem> foreign_name(const std::string& path, std::string_view name);
std::optional<Problem> foreign_folder(const std::string& path);

}  // namespace alphadot
