// Folders and files of a run: made with clear errors, and replaced whole so that a killed run leaves good
// ones.
#pragma once

#include <functional>
#include <string>
#include <string_view>

namespace alphadot {

/// Makes `folder` with its parents and proves that it can be written by creating a file in it. Throws
/// InputError with the reason and a remedy. Not collective: for one rank.
void make_run_folder(const std::string& folder);

/// Calls `write` with a temporary path beside `path` and puts the file it made there in the place of `path`:
/// fsync of the file, rename, fsync of the folder. Readers see the old file or the new one, never a part.
/// When anything fails the temporary file is removed, `path` stays as it was and the error goes on
/// (InputError for those of the system).
void replace_file(const std::string& path, const std::function<void(const std::string& temporary)>& write);

/// The same with the whole content in memory.
void replace_file_with(const std::string& path, std::string_view content);

}  // namespace alphadot
