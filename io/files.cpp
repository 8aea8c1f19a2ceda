#include "io/files.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
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

void make_run_folder(const std::string& folder) {
  const auto refuse = [&](const std::string& reason) {
    throw InputError(folder, 0, "the folder of the run cannot be written: " + reason,
                     "choose another with --out DIR or output.folder");
  };
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) refuse(error.message());
  if (!fs::is_directory(folder, error)) refuse("it is not a folder");
  const std::string probe = (fs::path(folder) / ".alphadot_probe").string();
  const int fd = open(probe.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  if (fd < 0) refuse(std::strerror(errno));
  close(fd);
  fs::remove(probe, error);
}

Replacement::~Replacement() {
  unlink(temporary_.c_str());  // after a commit there is none
}

void Replacement::commit() {
  sync(temporary_, O_RDWR);
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
