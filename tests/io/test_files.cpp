// Expectations: the guarantees stated in files.hpp, and what POSIX says of rename and of a file-size limit.
#include "io/files.hpp"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "core/error.hpp"
#include "io/temporary_folder.hpp"

namespace {
bool folders_fail = false;
}

/// In place of the system's: brings no folder to disk while `folders_fail`.
extern "C" int fsync(int fd) {
  struct stat found {};
  if (folders_fail && fstat(fd, &found) == 0 && S_ISDIR(found.st_mode)) {
    errno = EIO;
    return -1;
  }
  return static_cast<int>(syscall(SYS_fsync, fd));
}

namespace alphadot {
namespace {

std::string contents(const std::string& path) {
  std::ostringstream out;
  out << std::ifstream(path).rdbuf();
  return out.str();
}

std::size_t entries(const std::string& folder) {
  return static_cast<std::size_t>(
      std::distance(std::filesystem::directory_iterator(folder), std::filesystem::directory_iterator()));
}

TEST(FolderLock, MakesTheFolderWithItsParents) {
  const TemporaryFolder folder;
  {
    const FolderLock lock(folder / "a/b/c");
    std::ofstream(folder / "a/b/c/result") << "one";
  }
  EXPECT_EQ(entries(folder / "a/b/c"), 1u);
  const FolderLock again(folder / "a/b/c");
}

// A run that was refused leaves nothing behind; what was there before stays.
TEST(FolderLock, RemovesAnEmptyFolderThatItMade) {
  const TemporaryFolder folder;
  { const FolderLock lock(folder / "made"); }
  EXPECT_FALSE(std::filesystem::exists(folder / "made"));
  std::filesystem::create_directory(folder / "there");
  { const FolderLock lock(folder / "there"); }
  EXPECT_EQ(entries(folder / "there"), 0u);
}

TEST(FolderLock, HoldsOneFolderForOneOwner) {
  const TemporaryFolder folder;
  const FolderLock other(folder / "other");
  {
    const FolderLock lock(folder / "run");
    try {
      const FolderLock second(folder / "run");
      FAIL();
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find("another run works in this folder"), std::string::npos);
    }
  }
  const FolderLock next(folder / "run");
}

TEST(FolderLock, TakesWhatAKilledRunLeaves) {
  const TemporaryFolder folder;
  std::ofstream(folder / ".alphadot_lock") << "left";
  const FolderLock lock(folder.path());
}

TEST(FolderLock, RefusalNamesTheFolderAndTheRemedy) {
  const TemporaryFolder folder;
  std::ofstream(folder / "file") << "x";
  for (const std::string name : {"file", "file/below"}) {
    try {
      const FolderLock lock(folder / name);
      FAIL() << name;
    } catch (const InputError& error) {
      EXPECT_EQ(error.problems()[0].file, folder / name);
      EXPECT_NE(std::string(error.what()).find("--out"), std::string::npos);
    }
  }
  EXPECT_THROW(FolderLock("/proc/alphadot"), InputError);  // not even root may write there
}

TEST(ReadFile, RefusesWhatIsNoFileOfThatKind) {
  const TemporaryFolder folder;
  std::ofstream(folder / "text") << "abc";
  EXPECT_EQ(read_file(folder / "text", "table", 3), "abc");
  const auto message = [](const std::string& path) {
    try {
      read_file(path, "table", 2);
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_NE(message(folder / "text").find("too large for a table"), std::string::npos);
  EXPECT_NE(message(folder / "none").find("no such table"), std::string::npos);
  EXPECT_NE(message(folder.path()).find("the table is not a regular file"), std::string::npos);
  EXPECT_NE(message("/dev/zero").find("the table is not a regular file"), std::string::npos);
}

TEST(ReplaceFile, LeavesOnlyTheNewContent) {
  const TemporaryFolder folder;
  replace_file_with(folder / "f", "old");
  replace_file_with(folder / "f", "the new content");
  EXPECT_EQ(contents(folder / "f"), "the new content");
  EXPECT_EQ(entries(folder.path()), 1u);
}

TEST(ReplaceFile, AFailingWriterLeavesTheOldFile) {
  const TemporaryFolder folder;
  replace_file_with(folder / "f", "old");
  EXPECT_THROW(replace_file(folder / "f",
                            [](const std::string& temporary) {
                              std::ofstream(temporary) << "half";
                              throw std::runtime_error("stop");
                            }),
               std::runtime_error);
  EXPECT_THROW(replace_file(folder / "f", [](const std::string&) {}), InputError);  // nothing written
  EXPECT_EQ(contents(folder / "f"), "old");
  EXPECT_EQ(entries(folder.path()), 1u);
}

// What cannot be brought to disk does not take the place of what is there.
TEST(ReplaceFile, AFolderThatCannotBeBroughtToDiskKeepsTheOldFile) {
  const TemporaryFolder folder;
  replace_file_with(folder / "f", "old");
  folders_fail = true;
  EXPECT_THROW(replace_file_with(folder / "f", "new"), InputError);
  folders_fail = false;
  EXPECT_EQ(contents(folder / "f"), "old");
  EXPECT_EQ(entries(folder.path()), 1u);
}

TEST(ReplaceFile, NoSpaceLeavesTheOldFile) {
  const TemporaryFolder folder;
  replace_file_with(folder / "f", "old");
  std::signal(SIGXFSZ, SIG_IGN);  // the limit then shows as an error of write()
  rlimit before{};
  getrlimit(RLIMIT_FSIZE, &before);
  const rlimit small{4096, before.rlim_max};
  setrlimit(RLIMIT_FSIZE, &small);
  EXPECT_THROW(replace_file_with(folder / "f", std::string(100000, 'x')), InputError);
  setrlimit(RLIMIT_FSIZE, &before);
  EXPECT_EQ(contents(folder / "f"), "old");
  EXPECT_EQ(entries(folder.path()), 1u);
}

}  // namespace
}  // namespace alphadot
