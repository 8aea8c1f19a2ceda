// A seal at the end of a file: the hash of every byte before it. A damaged or cut file is found out before
// any library parses it; HDF5 and its readers do not look behind the end that a file states inside.
#pragma once

#include <string>
#include <string_view>

namespace alphadot {

/// Reads the file back and appends its seal. For one rank; throws InputError.
void seal_file(const std::string& path);

/// xxhash64 of a content, as 16 hexadecimal digits: the identity of an input.
std::string content_hash(std::string_view content);

/// Reads the whole file and throws InputError when its seal is missing or does not match. For one rank.
void check_seal(const std::string& path);

}  // namespace alphadot
