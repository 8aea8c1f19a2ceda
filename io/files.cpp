#include "io/files.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <system_error>
#include <thread>
#include <utility>

#include "core/error.hpp"

namespace alphadot {
namespace {

namespace fs = std::filesystem;

/// An open file of the system, closed at the end of its life.
class Descriptor {
 public:
  Descriptor(std::string path, int flags)
      : path_(std::move(path)), fd_(open(path_.c_str(), flags | O_CLOEXEC, 0666)) {
    if (fd_ < 0) fail("cannot be opened");
  }
  ~Descriptor() {
    if (fd_ >= 0) ::close(fd_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;

  void write(std::string_view content) {
    while (!content.empty()) {
      const auto written = ::write(fd_, content.data(), content.size());
      if (written < 0 && errno == EINTR) continue;
      if (written <= 0) fail("cannot be written");
      content.remove_prefix(static_cast<std::size_t>(written));
    }
  }
  void sync() {
    if (fsync(fd_) != 0) fail("cannot be brought to disk");
  }
  /// Some file systems tell of a full disk only here.
  void close() {
    if (::close(std::exchange(fd_, -1)) != 0) fail("cannot be closed");
  }

 private:
  [[noreturn]] void fail(const char* what) const {
    throw InputError(path_, 0, std::string(what) + ": " + std::strerror(errno),
                     "check free space, quota and permissions");
  }

  std::string path_;
  int fd_;
};

std::string folder_of(const std::string& path) {
  const auto folder = fs::path(path).parent_path();
  return folder.empty() ? "." : folder.string();
}

void sync(const std::string& path, int flags) {
  Descriptor file(path, flags);
  file.sync();
  file.close();
}

}  // namespace

FolderLock::FolderLock(const std::string& folder) : path_((fs::path(folder) / ".alphadot_lock").string()) {
  const auto refuse = [&](const std::string& reason) {
    throw InputError(folder, 0, reason, "choose another folder with --out DIR or output.folder");
  };
  const auto cannot_be_written = [&](const std::string& reason) {
    refuse("the folder of the run cannot be written: " + reason);
  };
  // Of a run that was killed a moment ago, some rank may not be gone yet.
  const auto patience = std::chrono::steady_clock::now() + std::chrono::seconds(3);
  while (fd_ < 0) {
    std::error_code error;
    is_made_here_ |= fs::create_directories(folder, error);
    if (error) cannot_be_written(error.message());
    if (!fs::is_directory(folder, error)) cannot_be_written("it is not a folder");
    const int fd = open(path_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
    // The folder may be gone again with the one before, who made it and left it empty.
    if (fd < 0 && errno == ENOENT && std::chrono::steady_clock::now() < patience) continue;
    if (fd < 0) cannot_be_written(std::strerror(errno));
    const bool is_taken = flock(fd, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK;
    // The one before removes its file: a lock on that is none on the file that is there now.
    struct stat locked {
    }, there{};
    const bool is_gone = fstat(fd, &locked) != 0 || stat(path_.c_str(), &there) != 0 ||
                         locked.st_ino != there.st_ino || locked.st_dev != there.st_dev;
    if (!is_taken && !is_gone) {
      fd_ = fd;
      break;
    }
    close(fd);
    if (std::chrono::steady_clock::now() > patience) refuse("another run works in this folder");
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
}

FolderLock::~FolderLock() {
  unlink(path_.c_str());
  if (is_made_here_) rmdir(fs::path(path_).parent_path().c_str());  // fails where something is in it
  close(fd_);
}

std::string read_file(const std::string& path, const std::string& what, std::uintmax_t most_bytes) {
  std::error_code error;
  if (!fs::exists(path, error)) throw InputError(path, 0, "no such " + what, "check the path");
  if (!fs::is_regular_file(path, error)) throw InputError(path, 0, "the " + what + " is not a regular file");
  const std::uintmax_t size = fs::file_size(path, error);
  if (size > most_bytes)
    throw InputError(path, 0, fmt::format("too large for a {} (above {} MiB)", what, most_bytes / (1 << 20)));
  std::ifstream stream(path, std::ios::binary);
  if (error || !stream) throw InputError(path, 0, "cannot be read", "check its permissions");
  std::string content(size, '\0');
  stream.read(content.data(), static_cast<std::streamsize>(size));
  if (static_cast<std::uintmax_t>(stream.gcount()) != size)
    throw InputError(path, 0, "cannot be read: it ends before its size is reached", "is it being written?");
  return content;
}

std::string content_of(const std::string& path) {
  std::ostringstream content;
  content << std::ifstream(path, std::ios::binary).rdbuf();
  return content.str();
}

Replacement::~Replacement() {
  unlink(temporary_.c_str());  // after a commit there is none
}

void Replacement::commit() {
  sync(temporary_, O_RDWR);
  sync(folder_of(path_), O_RDONLY | O_DIRECTORY);  // nothing is replaced where the disk does not take it
  if (std::rename(temporary_.c_str(), path_.c_str()) != 0)
    throw InputError(path_, 0, std::string("cannot be replaced: ") + std::strerror(errno));
  sync(folder_of(path_), O_RDONLY | O_DIRECTORY);
}

void replace_file(const std::string& path, const std::function<void(const std::string& temporary)>& write) {
  Replacement replacement(path);
  write(replacement.temporary());
  replacement.commit();
}

void replace_file_with(const std::string& path, std::string_view content) {
  replace_file(path, [&](const std::string& temporary) {
    Descriptor file(temporary, O_WRONLY | O_CREAT | O_TRUNC);
    file.write(content);
    file.close();
  });
}

}  // namespace alphadot
