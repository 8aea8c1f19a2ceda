// Prepared mesh files. Expectations: the mesh that was written comes back at any number of ranks, the file is
// the same byte for byte whoever wrote it, and damage is noticed.
#include "io/partitioned_mesh.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <numeric>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "io/hdf5.hpp"
#include "io/temporary_folder.hpp"
#include "partition/decompose.hpp"
#include "partition/slabs.hpp"
#include "partition/subdomain.hpp"
#include "support/box_mesh.hpp"

namespace alphadot {
namespace {

using testing_support::box_mesh;

constexpr int cells = 6 * 5 * 4 * 4;

std::string content(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

class PartitionedMesh : public testing::Test {
 protected:
  ~PartitionedMesh() override { comm.barrier(); }

  std::string in_folder(const std::string& name) const {
    return (std::filesystem::path(comm.broadcast(folder.path())) / name).string();
  }

  /// The box in so many pieces, prepared by the ranks of `who`.
  static std::string prepare(const std::string& path, int pieces, const Communicator& who) {
    const Mesh mesh = box_mesh({.cells = {5, 4, 4}, .upper = {2, 1, 1}, .perturbation = 0.1});
    const EqualSlabs slabs(cells, who.size());
    std::vector<int> owner;
    for (GlobalIndex cell = 0; cell < cells; ++cell) owner.push_back(slabs.rank_of(cell));
    const MeshPart part = scatter(mesh, owner, who);
    const RankMesh rank_mesh = gather_rank_mesh(part, who);
    const auto piece = decompose(rank_mesh, pieces, Partitioner::metis, "box", who);
    return write_partitioned_mesh(path, reorder(rank_mesh, piece, pieces, part.points, who), who);
  }

  void expect_error(const std::string& path, const std::string& text) const {
    try {
      read_partitioned_mesh(path, comm);
      FAIL() << text;
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find(text), std::string::npos) << error.what();
      EXPECT_FALSE(error.problems().at(0).remedy.empty());
    }
  }

  const Communicator comm;
  const TemporaryFolder folder;
};

TEST_F(PartitionedMesh, ComesBackOnAnyNumberOfRanks) {
  for (const int pieces : {1, 2, 4, 5, 6}) {
    const auto path = in_folder("box.h5");
    const auto hash = prepare(path, pieces, comm);
    const auto header = read_partitioned_mesh_header(path);
    EXPECT_EQ(header.pieces(), pieces);
    EXPECT_EQ(header.cells, cells);
    EXPECT_EQ(header.hash, hash);
    EXPECT_EQ(header.patch_names,
              (std::vector<std::string>{"x_min", "x_max", "y_min", "y_max", "z_min", "z_max"}));
    const Subdomain domain = distribute(read_partitioned_mesh(path, comm), comm);
    EXPECT_NO_THROW(domain.validate());
    EXPECT_EQ(domain.global_cells, cells);
    EXPECT_NEAR(
        comm.sum(std::accumulate(domain.volume.begin(), domain.volume.begin() + domain.owned_cells, Real{0})),
        2.0, 1e-13);
    if (pieces == comm.size()) {
      const auto rank = static_cast<std::size_t>(comm.rank());
      EXPECT_EQ(domain.owned_cells, header.piece_begin[rank + 1] - header.piece_begin[rank]);
    }
    comm.barrier();
  }
}

TEST_F(PartitionedMesh, IsTheSameFileFromAnyNumberOfRanks) {
  const auto alone = in_folder("alone.h5"), together = in_folder("together.h5");
  if (comm.is_root()) prepare(alone, 3, Communicator(MPI_COMM_SELF));
  prepare(together, 3, comm);
  comm.barrier();
  if (comm.is_root()) {
    EXPECT_EQ(content(alone), content(together));
  }
}

TEST_F(PartitionedMesh, NoticesDamage) {
  const auto path = in_folder("box.h5");
  prepare(path, 2, comm);
  const auto whole = content(path);
  comm.barrier();
  const auto write = [&](const std::string& bytes) {
    if (comm.is_root()) std::ofstream(path, std::ios::binary) << bytes;
    comm.barrier();
  };
  // One bit in each of many places: whatever is not noticed must be none of the mesh.
  const Subdomain sound = distribute(read_partitioned_mesh(path, comm), comm);
  int noticed = 0;
  constexpr std::size_t places = 40;
  for (std::size_t i = 0; i < places; ++i) {
    auto bytes = whole;
    bytes[(2 * i + 1) * whole.size() / (2 * places)] ^= 4;
    write(bytes);
    try {
      const Subdomain domain = distribute(read_partitioned_mesh(path, comm), comm);
      EXPECT_EQ(domain.cell_points, sound.cell_points);
      EXPECT_EQ(domain.volume, sound.volume);
      EXPECT_EQ(domain.boundary_faces.size(), sound.boundary_faces.size());
    } catch (const InputError&) {
      ++noticed;
    }
  }
  EXPECT_GT(noticed, 30);
  write(whole.substr(0, whole.size() / 2));
  EXPECT_THROW(read_partitioned_mesh(path, comm), InputError);
}

TEST_F(PartitionedMesh, RefusesOtherFiles) {
  const auto path = in_folder("other.h5");
  if (comm.is_root()) hdf5::File::create(path).close();
  comm.barrier();
  EXPECT_TRUE(is_hdf5(path));
  EXPECT_FALSE(is_partitioned_mesh(path));
  expect_error(path, "not a mesh prepared by alphadot partition");
  // A name tells another program's file that cannot be opened, and never one that can.
  const auto stub = in_folder("stub.msh.h5"), named = in_folder("named.msh.h5");
  if (comm.is_root()) std::ofstream(stub, std::ios::binary) << "\x89HDF\r\n\x1a\n";
  comm.barrier();
  expect_error(stub, "meshes of Fluent are not read");
  prepare(named, 1, comm);
  EXPECT_EQ(read_partitioned_mesh_header(named).cells, cells);
  const auto text = in_folder("text.h5");
  if (comm.is_root()) std::ofstream(text) << "$MeshFormat";
  comm.barrier();
  EXPECT_FALSE(is_hdf5(text));
}

TEST_F(PartitionedMesh, RefusesMoreRanksThanCells) {
  if (comm.size() == 1) GTEST_SKIP() << "one rank never has too few cells";
  const Mesh one{"one.msh",
                 {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
                 {{0, 1, 2, 3}},
                 {{"wall", {{0, 1, 2}, {0, 1, 3}, {0, 2, 3}, {1, 2, 3}}}}};
  const auto path = in_folder("one.h5");
  if (comm.is_root()) {
    const Communicator alone(MPI_COMM_SELF);
    const MeshPart part = scatter(one, {0}, alone);
    write_partitioned_mesh(path, reorder(gather_rank_mesh(part, alone), {0}, 1, part.points, alone), alone);
  }
  comm.barrier();
  expect_error(path, "ranks for 1 cells");
}

}  // namespace
}  // namespace alphadot
