// Recognises files that are no mesh the readers know, so that a message can name them.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "core/error.hpp"

namespace alphadot {

/// What a file is by its content, and what to do with it; nothing when it may be a mesh.
std::optional<Problem> foreign_content(const std::string& path, std::string_view content);

/// The same by its name, which is in lower case, or by its being a folder.
std::optional<Problem> foreign_name(const std::string& path, std::string_view name);
std::optional<Problem> foreign_folder(const std::string& path);

}  // namespace alphadot
