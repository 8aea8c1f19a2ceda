// Expectations: the guarantees stated in files.hpp, and what POSIX says of rename and of a file-size limit.
#include "io/files.hpp"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "core/error.hpp"
#include "io/temporary_folder.hpp"

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

TEST(RunFolder, IsMadeWithItsParentsAndLeftEmpty) {
  const TemporaryFolder folder;
  make_run_folder(folder / "a/b/c");
  EXPECT_EQ(entries(folder / "a/b/c"), 0u);
  make_run_folder(folder / "a/b/c");  // again: no error
}

TEST(RunFolder, RefusalNamesTheFolderAndTheRemedy) {
  const TemporaryFolder folder;
  std::ofstream(folder / "file") << "x";
  for (const std::string name : {"file", "file/below"}) {
    try {
      make_run_folder(folder / name);
      FAIL() << name;
    } catch (const InputError& error) {
      EXPECT_EQ(error.problems()[0].file, folder / name);
      EXPECT_NE(std::string(error.what()).find("--out"), std::string::npos);
    }
  }
  EXPECT_THROW(make_run_folder("/proc/alphadot"), InputError);  // not even root may write there
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
