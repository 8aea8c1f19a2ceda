// Expectations: what was written comes back bit for bit on any number of ranks; damage never passes for a
// checkpoint; the layout stated in checkpoint.hpp.
#include "io/checkpoint.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "case_file/case_difference.hpp"
#include "case_file/case_file.hpp"
#include "case_file/history_info.hpp"
#include "core/error.hpp"
#include "io/checkpoint_folder.hpp"
#include "io/files.hpp"
#include "io/seal.hpp"
#include "io/temporary_folder.hpp"
#include "support/box_mesh.hpp"

namespace alphadot {
namespace {

using testing_support::box_mesh;

Case plunge(const std::vector<std::string>& overrides = {}) {
  return parse_case(R"([mesh]
file = "finner.msh"
[freestream]
mach = 2.5
[boundary]
body = "wall"
[motion]
kind = "plunge"
)",
                    "plunge.toml", overrides);
}

/// Without structure, and no sum of products of ids: every bit counts.
Five<Real> state_of(GlobalIndex id, int level) {
  Five<Real> out;
  for (int k = 0; k < 5; ++k) out[k] = std::sin(1.0 + static_cast<Real>(id) * (k + 1) + 0.1 * level);
  return out;
}

/// A mesh on the ranks of the test with a folder that they share.
class CheckpointTest : public testing::Test {
 protected:
  CheckpointTest()
      : domain(distribute(box_mesh({.cells = {4, 3, 3}, .lower = {0, 0, 0}, .upper = {1, 1, 1}}), comm)),
        path((std::filesystem::path(comm.broadcast(own_folder.path())) / "c.vtkhdf").string()),
        file(domain, comm) {
    head.phase = "motion";
    head.numbers = {{"step", {7}}, {"largest", {0.1, 1.0 / 3, -0.0}}, {"none", {}}};
    head.message = "the residual dropped";
    head.history = History(history_info(plunge(), "0123456789abcdef"));
    for (int step = 0; step < 7; ++step)
      head.history.append({{"step", step}, {"total/Cm", 1.0 / (step + 3)}});
  }
  ~CheckpointTest() override { comm.barrier(); }

  std::vector<Five<Real>> states(int level) const {
    std::vector<Five<Real>> out;
    for (Index cell = 0; cell < domain.owned_cells; ++cell)
      out.push_back(state_of(domain.cell_ids[static_cast<std::size_t>(cell)], level));
    return out;
  }

  void write(const std::string& to) {
    auto flow = states(0), before = states(1);
    file.write(to, head, {{"flow", flow}, {"level_before", before}});
  }

  const Communicator comm;
  const TemporaryFolder own_folder;  // of each rank; that of the root is used
  const Subdomain domain;
  const std::string path;
  const CheckpointFile file;
  CheckpointHead head;
};

TEST_F(CheckpointTest, ComesBackBitForBit) {
  comm.on_root([] { std::filesystem::create_directories(ALPHADOT_SAMPLES); });
  write(std::string(ALPHADOT_SAMPLES) + "/checkpoint_" + std::to_string(comm.size()) + ".vtkhdf");
  write(path);
  std::vector<Five<Real>> flow(static_cast<std::size_t>(domain.owned_cells)), before = flow;
  file.read_fields(path, {{"level_before", before}, {"flow", flow}});
  for (std::size_t i = 0; i < flow.size(); ++i)
    for (int k = 0; k < 5; ++k) {
      EXPECT_EQ(flow[i][k], state_of(domain.cell_ids[i], 0)[k]);
      EXPECT_EQ(before[i][k], state_of(domain.cell_ids[i], 1)[k]);
    }
  check_seal(path);
  const auto read = read_checkpoint_head(path);
  EXPECT_EQ(read.phase, head.phase);
  EXPECT_EQ(read.message, head.message);
  EXPECT_EQ(read.numbers, head.numbers);
  EXPECT_TRUE(std::signbit(read.numbers.at("largest")[2]));
  EXPECT_EQ(read.history.names(), head.history.names());
  EXPECT_EQ(read.history.column("total/Cm"), head.history.column("total/Cm"));
  EXPECT_EQ(read.history.info.mesh_hash, "0123456789abcdef");
}

/// The cells stand in the order of the mesh file: the file written by one rank alone is the same.
TEST_F(CheckpointTest, DoesNotDependOnTheNumberOfRanks) {
  write(path);
  comm.on_root([&] {
    const Communicator self(MPI_COMM_SELF);
    const auto whole =
        distribute(box_mesh({.cells = {4, 3, 3}, .lower = {0, 0, 0}, .upper = {1, 1, 1}}), self);
    std::vector<Five<Real>> flow, before;
    for (Index cell = 0; cell < whole.owned_cells; ++cell) {
      flow.push_back(state_of(whole.cell_ids[static_cast<std::size_t>(cell)], 0));
      before.push_back(state_of(whole.cell_ids[static_cast<std::size_t>(cell)], 1));
    }
    CheckpointFile(whole, self).write(own_folder / "alone", head, {{"flow", flow}, {"level_before", before}});
    const auto content = [](const std::string& name) {
      std::ifstream in(name, std::ios::binary);
      return std::string(std::istreambuf_iterator<char>(in), {});
    };
    EXPECT_EQ(content(path), content(own_folder / "alone"));
  });
}

TEST_F(CheckpointTest, LeavesTheOldFileWhenItCannotWrite) {
  const std::string nowhere = comm.broadcast(own_folder / "none") + "/c.vtkhdf";
  EXPECT_THROW(write(nowhere), InputError);
  write(path);
  EXPECT_THROW(file.read_fields(path, {{"no_such_field", {}}}), InputError);
}

TEST_F(CheckpointTest, StatesOfAnotherMeshAreRefused) {
  write(path);
  const auto other = distribute(box_mesh({.cells = {3, 3, 3}, .lower = {0, 0, 0}, .upper = {1, 1, 1}}), comm);
  std::vector<Five<Real>> flow(static_cast<std::size_t>(other.owned_cells));
  EXPECT_THROW(CheckpointFile(other, comm).read_fields(path, {{"flow", flow}}), InputError);
}

/// No byte of a checkpoint can change, nor its end be lost, without notice.
TEST_F(CheckpointTest, AnyDamageShows) {
  write(path);
  comm.on_root([&] {
    const auto size = std::filesystem::file_size(path);
    const std::string damaged = own_folder / "damaged";
    for (std::uintmax_t at = 0; at < size; at += 1 + size / 60) {
      std::filesystem::copy_file(path, damaged, std::filesystem::copy_options::overwrite_existing);
      {
        std::fstream bytes(damaged, std::ios::binary | std::ios::in | std::ios::out);
        bytes.seekg(static_cast<std::streamoff>(at));
        const char changed = static_cast<char>(bytes.get() ^ 0x10);
        bytes.seekp(static_cast<std::streamoff>(at));
        bytes.put(changed);
      }
      EXPECT_THROW(check_seal(damaged), InputError) << "byte " << at;
      std::filesystem::copy_file(path, damaged, std::filesystem::copy_options::overwrite_existing);
      std::filesystem::resize_file(damaged, at);
      EXPECT_THROW(check_seal(damaged), InputError) << "cut at " << at;
    }
    EXPECT_THROW(check_seal(own_folder / "none"), InputError);
  });
}

TEST_F(CheckpointTest, AFolderKeepsTheNewestAndFallsBack) {
  std::vector<std::string> paths;
  std::optional<CheckpointFolder> folder;
  comm.on_root([&] { folder.emplace(std::filesystem::path(path).parent_path().string(), 2); });
  for (int i = 0; i < 3; ++i) {
    paths.push_back(comm.broadcast(comm.is_root() ? folder->next_path() : ""));
    write(paths.back());
    if (comm.is_root()) folder->added();
  }
  comm.on_root([&] {
    EXPECT_FALSE(std::filesystem::exists(paths[0]));
    EXPECT_EQ(std::filesystem::path(paths[2]).filename(), "checkpoint_000003.vtkhdf");
    std::filesystem::resize_file(paths[2], std::filesystem::file_size(paths[2]) - 1);
    std::vector<std::string> rejected;
    CheckpointFolder again(std::filesystem::path(path).parent_path().string(), 2);
    EXPECT_EQ(again.newest(rejected).path, paths[1]);
    ASSERT_EQ(rejected.size(), 1u);
    EXPECT_NE(rejected[0].find("checkpoint_000003.vtkhdf: is cut short"), std::string::npos) << rejected[0];
    EXPECT_EQ(std::filesystem::path(again.next_path()).filename(), "checkpoint_000004.vtkhdf");
    std::filesystem::resize_file(paths[1], 0);
    EXPECT_THROW(CheckpointFolder(std::filesystem::path(path).parent_path().string(), 2).newest(rejected),
                 InputError);
  });
}

TEST(CaseDifference, NamesWhatContradicts) {
  const auto keys = [](const std::vector<std::string>& overrides, Shared shared) {
    std::vector<std::string> out;
    for (const auto& difference : differences(plunge(), plunge(overrides), shared))
      out.push_back(difference.key);
    return out;
  };
  using Keys = std::vector<std::string>;
  EXPECT_EQ(keys({}, Shared::steps), Keys{});
  EXPECT_EQ(keys({"unsteady.cycles=3", "derivatives.orders=5", "output.flow=false", "checkpoint.keep=9",
                  "mesh.file=x.su2", "title=x"},
                 Shared::steps),
            Keys{});
  const std::vector<std::string> tolerances{"steady.orders=5", "unsteady.inner_tolerance=1e-5"};
  EXPECT_EQ(keys(tolerances, Shared::motion), Keys{});
  EXPECT_EQ(keys(tolerances, Shared::steps), (Keys{"steady.orders", "unsteady.inner_tolerance"}));
  EXPECT_EQ(keys({"freestream.mach=2", "boundary.body=sting"}, Shared::motion),
            (Keys{"freestream.mach", "boundary.*"}));
  const std::vector<std::string> motion{"motion.kind=pitch", "unsteady.steps_per_cycle=24"};
  EXPECT_EQ(keys(motion, Shared::motion), (Keys{"motion.kind", "unsteady.steps_per_cycle"}));
  EXPECT_EQ(keys(motion, Shared::flow), Keys{});
  EXPECT_EQ(keys({"space.flux=hllc"}, Shared::flow), Keys{"space.flux"});
}

}  // namespace
}  // namespace alphadot
