// Expectations: what was written is read back, and HDF5's documented behaviour on files that are not sound.
#include "io/hdf5.hpp"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <filesystem>
#include <fstream>

#include "core/error.hpp"
#include "io/temporary_folder.hpp"

namespace {
bool closing_fails = false;
}

/// In place of the system's: over quota, as network file systems tell only then, while `closing_fails`.
extern "C" int close(int fd) {
  const auto result = static_cast<int>(syscall(SYS_close, fd));
  if (!closing_fails) return result;
  errno = EDQUOT;
  return -1;
}

namespace alphadot {
namespace {

/// Objects that HDF5 holds open in this process.
ssize_t open_objects() {
  return H5Fget_obj_count(H5F_OBJ_ALL, H5F_OBJ_ALL);
}

template <class Work>
std::string message_of(Work work) {
  try {
    work();
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(Hdf5, TellsOfAFileThatCannotBeClosed) {
  const TemporaryFolder folder;
  const std::string message = message_of([&] {
    auto file = hdf5::File::create(folder / "a.h5");
    file.write("numbers", std::vector<double>(1000, 1.0));
    closing_fails = true;
    file.close();
  });
  closing_fails = false;
  EXPECT_NE(message.find("a.h5: cannot be written: Disk quota exceeded"), std::string::npos) << message;
  {
    auto file = hdf5::File::create(folder / "b.h5");  // and given up without a word: it is no crash
    file.write("numbers", std::vector<double>(1000, 1.0));
    closing_fails = true;
  }
  closing_fails = false;
  {
    const auto file = hdf5::File::open(folder / "b.h5");
    EXPECT_EQ(file.dataset("numbers").read<double>()[999], 1.0);
    closing_fails = true;
  }
  closing_fails = false;
  EXPECT_EQ(open_objects(), 0);
}

TEST(Hdf5, ReadsBackWhatItWrote) {
  const TemporaryFolder folder;
  const std::vector<double> numbers{1, 0.1, 1e300, -0.0, 5, 6};
  const std::vector<std::int64_t> large{std::int64_t{1} << 40, -1};
  {
    auto file = hdf5::File::create(folder / "a.h5");
    file.set_attribute("mach", 2.5);
    file.set_attribute("title", "Basic Finner é");
    file.set_attribute("empty", "");
    file.set_attribute("version", std::vector<std::int64_t>{1, 0});
    file.set_attribute("mach", 3.0);  // replaced
    const auto group = file.create_group("inner");
    group.write("numbers", numbers, 3).set_attribute("unit", "m");
    group.write("large", large);
    group.write("bytes", std::vector<std::uint8_t>{10, 255});
    group.write("none", std::vector<double>{});
    group.write_text("text", std::string(100000, 'x') + "\n");
    file.close();
  }
  EXPECT_EQ(open_objects(), 0);
  const auto file = hdf5::File::open(folder / "a.h5");
  EXPECT_EQ(file.attribute<double>("mach"), 3.0);
  EXPECT_EQ(file.text_attribute("title"), "Basic Finner é");
  EXPECT_EQ(file.text_attribute("empty"), "");
  EXPECT_EQ(file.attributes<std::int64_t>("version"), (std::vector<std::int64_t>{1, 0}));
  EXPECT_FALSE(file.has_attribute("gamma"));
  const auto group = file.group("inner");
  EXPECT_EQ(group.names(), (std::vector<std::string>{"bytes", "large", "none", "numbers", "text"}));
  const auto read = group.dataset("numbers");
  EXPECT_EQ(read.rows(), 2);
  EXPECT_EQ(read.columns(), 3);
  EXPECT_EQ(read.read<double>(), numbers);
  EXPECT_EQ(read.read<double>(1, 1), (std::vector<double>{-0.0, 5, 6}));
  EXPECT_EQ(read.text_attribute("unit"), "m");
  EXPECT_EQ(group.dataset("large").read<std::int64_t>(), large);
  EXPECT_EQ(group.dataset("bytes").read<double>(), (std::vector<double>{10, 255}));  // converted
  EXPECT_EQ(group.dataset("none").read<double>().size(), 0u);
  EXPECT_EQ(file.dataset("inner/text").read_text().size(), 100001u);
}

TEST(Hdf5, PiecesAndGrowthMakeTheWholeArray) {
  const TemporaryFolder folder;
  {
    auto file = hdf5::File::create(folder / "a.h5");
    auto pieces = file.create_dataset<float>("pieces", 5, 2);
    pieces.write(3, std::span<const float>(std::vector<float>{6, 7, 8, 9}));
    pieces.write(0, std::span<const float>(std::vector<float>{0, 1, 2, 3, 4, 5}));
    auto growing = file.create_growing<std::int32_t>("growing");
    for (std::int32_t i = 0; i < 10; ++i)
      growing.append(std::span<const std::int32_t>(std::vector<std::int32_t>(1000, i)));
    file.close();
  }
  const auto file = hdf5::File::open(folder / "a.h5");
  EXPECT_EQ(file.dataset("pieces").read<float>(), (std::vector<float>{0, 1, 2, 3, 4, 5, 6, 7, 8, 9}));
  const auto grown = file.dataset("growing").read<std::int32_t>();
  ASSERT_EQ(grown.size(), 10000u);
  for (std::size_t i = 0; i < grown.size(); ++i) ASSERT_EQ(grown[i], static_cast<std::int32_t>(i / 1000));
}

TEST(Hdf5, EqualContentMakesEqualFiles) {
  const TemporaryFolder folder;
  const auto write = [&](const std::string& name) {
    auto file = hdf5::File::create(folder / name);
    file.create_group("g").write("x", std::vector<double>{1, 2, 3});
    file.close();
    std::ifstream stream(folder / name, std::ios::binary);
    return std::string(std::istreambuf_iterator<char>(stream), {});
  };
  EXPECT_EQ(write("a.h5"), write("b.h5"));
}

TEST(Hdf5, ErrorsNameTheFileAndWhatFailed) {
  const TemporaryFolder folder;
  {
    auto file = hdf5::File::create(folder / "a.h5");
    file.write("x", std::vector<double>{1, 2, 3});
    file.set_attribute("text", "t");
    file.set_attribute("pair", std::vector<double>{1, 2});
  }
  const auto file = hdf5::File::open(folder / "a.h5");
  const auto expect = [&](auto work, const std::string& part) {
    const auto message = message_of(work);
    EXPECT_NE(message.find(folder / "a.h5"), std::string::npos) << message;
    EXPECT_NE(message.find(part), std::string::npos) << message;
  };
  expect([&] { file.dataset("y"); }, "no dataset /y");
  expect([&] { file.group("g"); }, "no group /g");
  expect([&] { file.attribute<double>("mach"); }, "attribute mach of /");
  expect([&] { file.attribute<double>("pair"); }, "must hold one value, not 2");
  expect([&] { file.text_attribute("pair"); }, "it is not one text");
  expect([&] { file.dataset("x").read<double>(2, 2); }, "no rows 2 to 4");
  expect([&] { file.dataset("x").read<double>(-1, 1); }, "no rows -1 to 0");
  expect([&] { file.dataset("x").read_text(); }, "it is not one text");
}

TEST(Hdf5, UnsoundFilesAreRefused) {
  const TemporaryFolder folder;
  EXPECT_NE(message_of([&] { hdf5::File::open(folder / "none.h5"); }).find("No such file or directory"),
            std::string::npos);
  std::ofstream(folder / "text.h5") << "step,time\n1,2\n";
  EXPECT_NE(message_of([&] { hdf5::File::open(folder / "text.h5"); }).find("not an HDF5 file"),
            std::string::npos);
  {
    auto file = hdf5::File::create(folder / "a.h5");
    file.write("x", std::vector<double>(10000, 1.0));
    file.create_dataset<double>("never_written", 1000);
    file.close();
  }
  EXPECT_NE(message_of([&] {
              hdf5::File::open(folder / "a.h5").dataset("never_written").read<double>();
            }).find("less data"),
            std::string::npos);
  std::filesystem::resize_file(folder / "a.h5", 40000);
  EXPECT_NE(message_of([&] { hdf5::File::open(folder / "a.h5"); }).find("incomplete"), std::string::npos);
  EXPECT_NE(message_of([&] { hdf5::File::create("/proc/alphadot.h5"); }).find("cannot be created"),
            std::string::npos);
  EXPECT_EQ(open_objects(), 0);
}

TEST(Hdf5, NoSpaceIsAnErrorAndLeavesNothingOpen) {
  const TemporaryFolder folder;
  std::signal(SIGXFSZ, SIG_IGN);  // the limit then shows as an error of write()
  rlimit before{};
  getrlimit(RLIMIT_FSIZE, &before);
  for (const rlim_t limit : {0ul, 100ul, 4096ul, 300000ul}) {
    const rlimit small{limit, before.rlim_max};
    setrlimit(RLIMIT_FSIZE, &small);
    const auto message = message_of([&] {
      auto file = hdf5::File::create(folder / "a.h5");
      file.write("x", std::vector<double>(100000, 1.0));
      file.set_attribute("mach", 1.0);
      file.close();
    });
    setrlimit(RLIMIT_FSIZE, &before);
    EXPECT_NE(message.find("File too large"), std::string::npos) << limit << " " << message;
    EXPECT_EQ(open_objects(), 0) << limit;
  }
  auto file = hdf5::File::create(folder / "a.h5");  // the same path works again
  file.write("x", std::vector<double>(100000, 1.0));
  file.close();
}

}  // namespace
}  // namespace alphadot
