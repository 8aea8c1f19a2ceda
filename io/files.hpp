// Folders and files of a run: made with clear errors, and replaced whole so that a killed run leaves good
// ones.
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <utility>

namespace alphadot {

/// Makes `folder` with its parents and proves that it can be written by creating a file in it. Throws
/// InputError with the reason and a remedy. Not collective: for one rank.
void make_run_folder(const std::string& folder);

/// A file on its way to take the place of `path`: written at temporary(), then committed. Readers of `path`
/// see the old file or the new one, never a part. Without a commit the temporary file is removed and `path`
/// stays.
class Replacement {
 public:
  explicit Replacement(std::string path) : path_(std::move(path)), temporary_(path_ + ".part") {}
  ~Replacement();
  Replacement(const Replacement&) = delete;
  Replacement& operator=(const Replacement&) = delete;

  const std::string& temporary() const { return temporary_; }
  /// fsync of the file, rename, fsync of the folder. Throws InputError.
  void commit();

 private:
  std::string path_, temporary_;
};

/// Replaces the file `path` by one that `write` makes at the temporary path it is given. What `write` throws
/// goes on.
void replace_file(const std::string& path, const std::function<void(const std::string& temporary)>& write);

/// The same with the whole content in memory.
void replace_file_with(const std::string& path, std::string_view content);

}  // namespace alphadot
