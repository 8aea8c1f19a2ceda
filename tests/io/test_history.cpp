// Expectations: what was written is read back; the layout stated in history.hpp; damage is told from
// soundness.
#include "io/history.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "case_file/case_file.hpp"
#include "case_file/history_info.hpp"
#include "core/error.hpp"
#include "io/temporary_folder.hpp"
#include "motion/settings.hpp"

namespace alphadot {
namespace {

Case plunge() {
  return parse_case(R"(title = "Finner"
[mesh]
file = "finner.msh"
[reference]
length = 2
area = 3.14
moment_center = [5.5, 0, 0.25]
model = "half"
[freestream]
mach = 2.5
alpha = 1.5
[boundary]
body = "wall"
[motion]
kind = "plunge"
reduced_frequency = 0.02
)",
                    "plunge.toml");
}

History example(int steps) {
  History history(history_info(plunge(), "0123456789abcdef"));
  for (int step = 0; step < steps; ++step) {
    const Real t = 0.1 * step;
    history.append({{"step", step},
                    {"t_star", t},
                    {"total/CN", std::sin(t)},
                    {"total/CA", 1.0 / 3},
                    {"body/CA", t * t}});
  }
  return history;
}

std::string message_of(const std::string& path) {
  try {
    read_history(path);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(History, ReadsBackBitForBit) {
  const TemporaryFolder folder;
  const History written = example(100);
  write_history(folder.path(), written);
  const History read = read_history(folder / "history.h5");
  EXPECT_EQ(read.names(), written.names());
  EXPECT_EQ(read.steps(), 100u);
  for (const auto& name : written.names()) EXPECT_EQ(read.column(name), written.column(name)) << name;
  EXPECT_EQ(read.components(), (std::vector<std::string>{"total", "body"}));
  EXPECT_EQ(read.info.title, "Finner");
  EXPECT_EQ(read.info.reference.length, 2);
  EXPECT_EQ(read.info.reference.area, 3.14);
  EXPECT_EQ(read.info.reference.moment_center.z, 0.25);
  EXPECT_TRUE(read.info.reference.half_model);
  EXPECT_EQ(read.info.freestream.mach, 2.5);
  EXPECT_EQ(read.info.freestream.alpha, 1.5);
  EXPECT_EQ(read.info.freestream.gamma, 1.4);
  EXPECT_EQ(read.info.motion.kind, MotionKind::plunge);
  EXPECT_EQ(read.info.motion.reduced_frequency, 0.02);
  EXPECT_EQ(read.info.motion.amplitude, 1);
  EXPECT_EQ(read.info.motion.axis_point.x, 5.5);
  EXPECT_EQ(read.info.mesh_hash, "0123456789abcdef");
  EXPECT_EQ(read.info.version, written.info.version);
  EXPECT_EQ(resolved_case(parse_case(read.info.case_text, "c.toml")), resolved_case(plunge()));
}

TEST(History, CanGoOnAfterReading) {
  const TemporaryFolder folder;
  write_history(folder.path(), example(3));
  History history = read_history(folder / "history.h5");
  history.append({{"step", 3}, {"t_star", 0.3}, {"total/CN", 0}, {"total/CA", 0}, {"body/CA", 0}});
  write_history(folder.path(), history);
  EXPECT_EQ(read_history(folder / "history.h5").column("step"), (std::vector<Real>{0, 1, 2, 3}));
}

TEST(History, CsvHoldsEveryDigit) {
  const TemporaryFolder folder;
  write_history(folder.path(), example(2));
  std::ostringstream csv;
  csv << std::ifstream(folder / "history.csv").rdbuf();
  // 1/3 and sin(0.1) to the shortest text that reads back the same, as Python's repr gives them.
  EXPECT_EQ(csv.str(),
            "# Flow: Mach 2.5, alpha 1.5 deg, beta 0 deg, gamma 1.4; mesh finner.msh, hash 0123456789abcdef; "
            "alphadot " +
                history_info(plunge(), "").version +
                "\nstep,t_star,total/CN,total/CA,body/CA\n"
                "0,0,0,0.3333333333333333,0\n"
                "1,0.1,0.09983341664682815,0.3333333333333333,0.010000000000000002\n");
}

TEST(History, EmptyAndNotANumberSurvive) {
  const TemporaryFolder folder;
  write_history(folder.path(), History(history_info(plunge(), "")));
  EXPECT_EQ(read_history(folder / "history.h5").steps(), 0u);
  History history(history_info(plunge(), ""));
  history.append({{"step", 0}, {"total/CA", NAN}});
  write_history(folder.path(), history);
  EXPECT_TRUE(std::isnan(read_history(folder / "history.h5").column("total/CA")[0]));
}

TEST(History, RowsMustAgree) {
  History history = example(1);
  EXPECT_THROW(history.append({{"step", 1}}), std::logic_error);
  EXPECT_THROW(History().append({{"a", 1}, {"a", 2}}), InputError);
  try {
    history.column("total/Cm");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("it has step, t_star, total/CN"), std::string::npos)
        << error.what();
  }
}

TEST(History, ForeignAndDamagedFilesAreRefused) {
  const TemporaryFolder folder;
  EXPECT_NE(message_of(folder / "none.h5").find("No such file or directory"), std::string::npos);
  std::ofstream(folder / "history.csv") << "step\n1\n";
  EXPECT_NE(message_of(folder / "history.csv").find("not an HDF5 file"), std::string::npos);
  {
    auto file = hdf5::File::create(folder / "foreign.h5");
    file.write("x", std::vector<double>{1});
  }
  EXPECT_NE(message_of(folder / "foreign.h5").find("not a history of alphadot"), std::string::npos);
  {
    auto file = hdf5::File::create(folder / "future.h5");
    example(1).write(file);
    file.set_attribute("format_version", std::int64_t{99});
  }
  EXPECT_NE(message_of(folder / "future.h5").find("format 99"), std::string::npos);
  {
    auto file = hdf5::File::create(folder / "motion.h5");
    example(2).write(file);
    file.set_attribute("motion", "tumble");
  }
  EXPECT_NE(message_of(folder / "motion.h5").find("unknown value \"tumble\""), std::string::npos);
}

/// Cut anywhere, a file is refused; the few bytes at its end that hold nothing may be missed.
TEST(History, TruncatedFilesAreRefused) {
  const TemporaryFolder folder;
  write_history(folder.path(), example(50));
  const auto size = std::filesystem::file_size(folder / "history.h5");
  for (int part = 0; part < 40; ++part) {
    std::filesystem::copy_file(folder / "history.h5", folder / "cut.h5",
                               std::filesystem::copy_options::overwrite_existing);
    std::filesystem::resize_file(folder / "cut.h5", size * static_cast<std::size_t>(part) / 40);
    EXPECT_NE(message_of(folder / "cut.h5"), "") << part;
  }
}

}  // namespace
}  // namespace alphadot
