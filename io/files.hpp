// Folders and files of a run: made with clear errors, and replaced whole so that a killed run leaves good
// ones.
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <string_view>
#include <utility>

namespace alphadot {

/// A folder of a run: made with its parents, proved to be writable, and of one run alone for the life of the
/// object. The lock is the kernel's, on a file in the folder: it ends with the process, however that ends,
/// and is not there on file systems without locks. Not collective: for one rank.
class FolderLock {
 public:
  /// Throws InputError with the reason and a remedy; also when another process has the folder and keeps it
  /// for some seconds.
  explicit FolderLock(const std::string& folder);
  ~FolderLock();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

 private:
  std::string path_;
  int fd_ = -1;
  bool is_made_here_ = false;
};

/// The content of a regular file of at most `most_bytes`; `what` it is for messages, "case file". Throws
/// InputError. Not collective: for one rank.
std::string read_file(const std::string& path, const std::string& what,
                      std::uintmax_t most_bytes = std::numeric_limits<std::uintmax_t>::max());

/// The content of a file that may be there or not, or be written at the moment; empty when it cannot be read.
std::string content_of(const std::string& path);

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
  /// fsync of the file and of the folder, rename, fsync of the folder. Throws InputError, with the old file
  /// in its place unless it is the last fsync that fails.
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
