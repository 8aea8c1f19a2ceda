// Preparing a mesh in parallel: refinement, cutting by either library, the order of pieces. Expectations: the
// box's own volume and areas, counts that follow from the definition of the refinement, and the same result
// at every number of ranks.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numeric>
#include <set>
#include <utility>

#include "core/error.hpp"
#include "parallel.hpp"
#include "partition/decompose.hpp"
#include "partition/refine.hpp"
#include "partition/reorder.hpp"
#include "partition/slabs.hpp"
#include "partition/space_filling_curve.hpp"
#include "partition/subdomain.hpp"

namespace alphadot {
namespace {

using testing_support::gather;
using testing_support::random_owners;
using testing_support::test_box;

/// The box in equal stretches of its order.
MeshPart box_part(const Communicator& comm) {
  const Mesh mesh = test_box();
  const EqualSlabs slabs(static_cast<GlobalIndex>(mesh.cells.size()), comm.size());
  std::vector<int> owner;
  for (GlobalIndex cell = 0; cell < slabs.total; ++cell) owner.push_back(slabs.rank_of(cell));
  return scatter(mesh, owner, comm);
}

Real total_volume(const Subdomain& domain, const Communicator& comm) {
  return comm.sum(
      std::accumulate(domain.volume.begin(), domain.volume.begin() + domain.owned_cells, Real{0}));
}

TEST(Refine, CutsTheBoxIntoEightTimesTheCells) {
  const Communicator comm;
  const MeshPart coarse = box_part(comm);
  const MeshPart fine = refine(coarse, comm);
  EXPECT_EQ(fine.global_cells, 8 * coarse.global_cells);
  EXPECT_EQ(fine.global_triangles, 4 * coarse.global_triangles);
  // Euler's formula of a ball, P - E + F - C = 1, gives the edges, of which each makes a point.
  const GlobalIndex faces = (4 * coarse.global_cells + coarse.global_triangles) / 2;
  EXPECT_EQ(fine.global_points - coarse.global_points,
            coarse.global_points + faces - coarse.global_cells - 1);
  const Subdomain domain = distribute(fine, comm);
  EXPECT_NO_THROW(domain.validate());
  EXPECT_NEAR(total_volume(domain, comm), 3.5 * 1.2 * 1, 1e-12);
}

// Children of a tetrahedron have an eighth of its volume each, whatever diagonal is taken.
TEST(Refine, SharesVolumesEvenly) {
  const Communicator comm;
  const Subdomain coarse = distribute(box_part(comm), comm),
                  fine = distribute(refine(box_part(comm), comm), comm);
  for (Index cell = 0; cell < fine.owned_cells; ++cell) {
    const auto parent = std::find(coarse.cell_ids.begin(), coarse.cell_ids.end(), fine.cell_ids[cell] / 8);
    ASSERT_NE(parent, coarse.cell_ids.end());
    EXPECT_NEAR(fine.volume[cell], coarse.volume[parent - coarse.cell_ids.begin()] / 8, 1e-15);
  }
}

TEST(Refine, Twice) {
  const Communicator comm;
  const Subdomain domain = distribute(refine(refine(box_part(comm), comm), comm), comm);
  EXPECT_NO_THROW(domain.validate());
  EXPECT_EQ(domain.global_cells, 64 * 840);
}

class Decompose : public testing::TestWithParam<Partitioner> {};
INSTANTIATE_TEST_SUITE_P(Libraries, Decompose, testing::Values(Partitioner::metis, Partitioner::ptscotch),
                         [](const auto& library) {
                           return library.param == Partitioner::metis ? "metis" : "ptscotch";
                         });

// 840 cells in 4 parts of 210. The surface of a cube of so many cells has 6 (210 / 6)^(2/3) * 2 faces; a part
// of the box has less of it inside.
TEST_P(Decompose, MakesEvenPartsOfSmallSurface) {
  const Communicator comm;
  constexpr int parts = 4;
  const RankMesh rank_mesh = gather_rank_mesh(box_part(comm), comm);
  const auto part = decompose(rank_mesh, parts, GetParam(), "box", comm);
  ASSERT_EQ(part.size(), static_cast<std::size_t>(rank_mesh.owned_cells()));
  std::vector<GlobalIndex> size(parts, 0);
  for (const int p : part) {
    ASSERT_TRUE(p >= 0 && p < parts);
    ++size[static_cast<std::size_t>(p)];
  }
  comm.sum(std::span<GlobalIndex>(size));
  for (const GlobalIndex cells : size) EXPECT_NEAR(cells, 210, 0.03 * 210);

  const auto mesh = reorder(rank_mesh, part, parts, box_part(comm).points, comm);
  const auto domain = distribute(mesh.part, comm);
  EXPECT_NO_THROW(domain.validate());
  GlobalIndex cut = 0;
  const auto piece_of = [&](GlobalIndex cell) {
    return std::upper_bound(mesh.piece_begin.begin(), mesh.piece_begin.end(), cell);
  };
  for (const auto& [left, right] : domain.faces)
    cut += piece_of(domain.cell_ids[left]) != piece_of(domain.cell_ids[right])
               ? (right < domain.owned_cells ? 2 : 1)
               : 0;
  const Real cube_faces = 6 * std::pow(210.0 / 6, 2.0 / 3) * 2;
  EXPECT_LT(static_cast<Real>(comm.sum(cut)), parts * cube_faces);
}

TEST_P(Decompose, RefusesMorePartsThanCells) {
  const Communicator comm;
  const RankMesh rank_mesh = gather_rank_mesh(box_part(comm), comm);
  EXPECT_THROW(decompose(rank_mesh, 841, GetParam(), "box", comm), InputError);
}

// Cells, triangles and pieces only change their places: seen through points, the mesh stays what it was.
TEST(Reorder, KeepsTheMesh) {
  const Communicator comm;
  const Mesh mesh = test_box();
  const MeshPart part = box_part(comm);
  const RankMesh rank_mesh = gather_rank_mesh(part, comm);
  const auto owner = random_owners(mesh, 5);
  std::vector<int> piece;
  for (Index cell = 0; cell < rank_mesh.owned_cells(); ++cell)
    piece.push_back(owner[rank_mesh.cell_ids[cell]]);
  const OrderedMesh ordered = reorder(rank_mesh, piece, 5, part.points, comm);

  EXPECT_EQ(ordered.piece_begin.front(), 0);
  EXPECT_EQ(ordered.piece_begin.back(), 840);
  std::multiset<GlobalIndex> sizes, expected_sizes;
  for (std::size_t i = 0; i < 5; ++i) sizes.insert(ordered.piece_begin[i + 1] - ordered.piece_begin[i]);
  for (int i = 0; i < 5; ++i) expected_sizes.insert(std::count(owner.begin(), owner.end(), i));
  EXPECT_EQ(sizes, expected_sizes);

  std::vector<GlobalIndex> corners, triangles;
  for (const auto& cell : ordered.part.cells) corners.insert(corners.end(), cell.begin(), cell.end());
  for (const auto& triangle : ordered.part.triangles) {
    triangles.insert(triangles.end(), triangle.points.begin(), triangle.points.end());
    triangles.push_back(triangle.patch);
  }
  const auto all = gather(corners, comm), all_triangles = gather(triangles, comm);
  std::multiset<std::array<GlobalIndex, 4>> found, found_triangles, expected_triangles;
  for (std::size_t i = 0; i < all.size(); i += 4) found.insert({all[i], all[i + 1], all[i + 2], all[i + 3]});
  EXPECT_EQ(found, std::multiset(mesh.cells.begin(), mesh.cells.end()));
  for (std::size_t i = 0; i < all_triangles.size(); i += 4)
    found_triangles.insert(
        {all_triangles[i], all_triangles[i + 1], all_triangles[i + 2], all_triangles[i + 3]});
  for (std::size_t patch = 0; patch < mesh.patches.size(); ++patch)
    for (const auto& t : mesh.patches[patch].triangles)
      expected_triangles.insert({t[0], t[1], t[2], static_cast<GlobalIndex>(patch)});
  EXPECT_EQ(found_triangles, expected_triangles);

  const auto cells_behind = gather(ordered.triangle_cell, comm);
  ASSERT_EQ(4 * cells_behind.size(), all_triangles.size());
  EXPECT_TRUE(std::is_sorted(cells_behind.begin(), cells_behind.end()));
  for (std::size_t i = 0; i < cells_behind.size(); ++i) {
    const auto cell = all.begin() + 4 * cells_behind[i];
    for (std::size_t k = 0; k < 3; ++k)
      EXPECT_NE(std::find(cell, cell + 4, all_triangles[4 * i + k]), cell + 4) << "triangle " << i;
  }
}

// Hilbert's curve goes from one octant to the next without a jump: consecutive cubes of a grid touch.
TEST(SpaceFillingCurve, VisitsNeighboursInTurn) {
  constexpr int n = 8;
  std::vector<std::pair<std::uint64_t, std::array<int, 3>>> cubes;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j)
      for (int k = 0; k < n; ++k)
        cubes.push_back({hilbert_position({i + 0.5, j + 0.5, k + 0.5}, {{0, 0, 0}, {n, n, n}}), {i, j, k}});
  std::sort(cubes.begin(), cubes.end());
  for (std::size_t i = 1; i < cubes.size(); ++i) {
    int steps = 0;
    for (std::size_t axis = 0; axis < 3; ++axis)
      steps += std::abs(cubes[i].second[axis] - cubes[i - 1].second[axis]);
    EXPECT_EQ(steps, 1) << i;
  }
}

}  // namespace
}  // namespace alphadot
