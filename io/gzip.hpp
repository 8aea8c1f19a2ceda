// Files compressed by gzip.
#pragma once

#include <string>
#include <string_view>

namespace alphadot {

/// Whether `content` begins as gzip's files do.
bool is_gzip(std::string_view content);

/// What is compressed in `content`. `file` names it in messages. Throws InputError for damaged files and for
/// contents of more than 100 times the file and 1 MiB, which no mesh has.
std::string gunzip(std::string_view content, const std::string& file);

}  // namespace alphadot
