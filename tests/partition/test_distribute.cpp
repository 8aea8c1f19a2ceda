// Cutting a mesh into Subdomains. Expectations: brute force over the whole mesh, which every rank holds here,
// or the same mesh distributed to this rank alone.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <set>
#include <string>
#include <utility>

#include "core/error.hpp"
#include "parallel.hpp"
#include "partition/delivery.hpp"
#include "partition/subdomain.hpp"

namespace alphadot {
namespace {

using testing_support::box_mesh;
using testing_support::gather;
using testing_support::random_owners;
using testing_support::test_box;

bool same(const Vec3& a, const Vec3& b) {
  return a.x == b.x && a.y == b.y && a.z == b.z;
}

std::vector<GlobalIndex> counting(std::size_t n) {
  std::vector<GlobalIndex> out(n);
  std::iota(out.begin(), out.end(), 0);
  return out;
}

/// Every test runs on a partition by METIS and on a random one.
class Distribute : public testing::TestWithParam<bool> {
 protected:
  Subdomain distributed(Real scale = 1) const {
    return GetParam() ? distribute(mesh, random_owners(mesh, comm.size()), comm, scale)
                      : distribute(mesh, comm, scale);
  }
  GlobalIndex global_cell(const Subdomain& domain, Index cell) const { return domain.cell_ids[cell]; }

  const Communicator comm;
  const Mesh mesh = test_box();
};
INSTANTIATE_TEST_SUITE_P(Partitions, Distribute, testing::Bool(),
                         [](const auto& random) { return random.param ? "random" : "metis"; });

TEST_P(Distribute, GivesSoundSubdomains) {
  EXPECT_NO_THROW(distributed().validate());
}

TEST_P(Distribute, GivesEveryCellToOneRank) {
  const Subdomain domain = distributed();
  EXPECT_EQ(domain.global_cells, static_cast<GlobalIndex>(mesh.cells.size()));
  EXPECT_EQ(domain.global_points, static_cast<GlobalIndex>(mesh.points.size()));
  auto ids = gather({domain.cell_ids.begin(), domain.cell_ids.begin() + domain.owned_cells}, comm);
  std::sort(ids.begin(), ids.end());
  EXPECT_EQ(ids, counting(mesh.cells.size()));
}

TEST_P(Distribute, KeepsTheCornersOfCells) {
  const Subdomain domain = distributed();
  for (Index cell = 0; cell < domain.total_cells; ++cell)
    for (std::size_t i = 0; i < 4; ++i) {
      const auto local = static_cast<std::size_t>(domain.cell_points[cell][i]);
      const GlobalIndex point = mesh.cells[global_cell(domain, cell)][i];
      EXPECT_EQ(domain.point_ids[local], point);
      EXPECT_TRUE(same(domain.points[local], mesh.points[point]));
    }
}

// The box is 3.5 x 1.2 x 1; 840 volumes are summed.
TEST_P(Distribute, FillsTheBox) {
  const Subdomain domain = distributed();
  const Real volume =
      comm.sum(std::accumulate(domain.volume.begin(), domain.volume.begin() + domain.owned_cells, Real{0}));
  EXPECT_NEAR(volume, 3.5 * 1.2 * 1, 1e-13);
  Vec3 area[6];
  for (std::size_t i = 0; i < domain.boundary_faces.size(); ++i)
    area[domain.boundary_faces[i].patch] += domain.boundary_normal[i];
  const Real expected[3] = {1.2 * 1, 3.5 * 1, 3.5 * 1.2};
  for (int patch = 0; patch < 6; ++patch)
    for (int d = 0; d < 3; ++d)
      EXPECT_NEAR(comm.sum(area[patch][d]), d == patch / 2 ? (patch % 2 ? 1 : -1) * expected[d] : 0, 1e-13)
          << patch << d;
}

TEST_P(Distribute, ScalesPoints) {
  const Subdomain metres = distributed(), millimetres = distributed(1000);
  EXPECT_NO_THROW(millimetres.validate());
  EXPECT_NEAR(comm.sum(std::accumulate(millimetres.volume.begin(),
                                       millimetres.volume.begin() + millimetres.owned_cells, Real{0})),
              3.5 * 1.2 * 1 * 1e9, 1e-4);
  for (std::size_t i = 0; i < metres.points.size(); ++i)
    EXPECT_TRUE(same(1000.0 * metres.points[i], millimetres.points[i]));
}

// Definition: the ghosts are the cells of other ranks that share a point with an owned cell.
TEST_P(Distribute, HasTheCellsAroundItsOwnAsGhosts) {
  const Subdomain domain = distributed();
  const std::set<GlobalIndex> owned(domain.cell_ids.begin(), domain.cell_ids.begin() + domain.owned_cells);
  std::set<GlobalIndex> owned_points, expected;
  for (const GlobalIndex cell : owned) owned_points.insert(mesh.cells[cell].begin(), mesh.cells[cell].end());
  for (std::size_t cell = 0; cell < mesh.cells.size(); ++cell)
    for (const GlobalIndex point : mesh.cells[cell])
      if (owned_points.contains(point) && !owned.contains(static_cast<GlobalIndex>(cell)))
        expected.insert(static_cast<GlobalIndex>(cell));
  EXPECT_EQ(std::set<GlobalIndex>(domain.cell_ids.begin() + domain.owned_cells, domain.cell_ids.end()),
            expected);
  EXPECT_EQ(static_cast<std::size_t>(domain.total_cells - domain.owned_cells), expected.size());
}

TEST_P(Distribute, KnowsEveryCellAroundItsPoints) {
  std::vector<std::set<GlobalIndex>> around(mesh.points.size());
  for (std::size_t cell = 0; cell < mesh.cells.size(); ++cell)
    for (const GlobalIndex point : mesh.cells[cell]) around[point].insert(static_cast<GlobalIndex>(cell));
  const Subdomain domain = distributed();
  for (Index point = 0; point < domain.owned_points; ++point) {
    std::set<GlobalIndex> found;
    for (const Index cell : domain.point_cells[point]) found.insert(global_cell(domain, cell));
    EXPECT_EQ(found, around[domain.point_ids[point]]);
    EXPECT_EQ(found.size(), domain.point_cells[point].size());
  }
}

TEST_P(Distribute, HasEveryBoundaryFaceOnce) {
  const Subdomain domain = distributed();
  std::vector<std::pair<Index, std::set<GlobalIndex>>> triangles;  // patch, points
  for (std::size_t patch = 0; patch < mesh.patches.size(); ++patch) {
    EXPECT_EQ(domain.patch_names[patch], mesh.patches[patch].name);
    for (const auto& points : mesh.patches[patch].triangles)
      triangles.emplace_back(static_cast<Index>(patch), std::set(points.begin(), points.end()));
  }
  std::vector<GlobalIndex> mine;
  for (const auto& face : domain.boundary_faces) {
    mine.push_back(face.id);
    std::set<GlobalIndex> points;
    for (const Index point : face.points) points.insert(domain.point_ids[point]);
    EXPECT_EQ(std::pair(face.patch, points), triangles[face.id]);
  }
  auto ids = gather(mine, comm);
  std::sort(ids.begin(), ids.end());
  EXPECT_EQ(ids, counting(triangles.size()));
}

// Bitwise: a run must not depend on where the mesh is cut. Face normals may only differ in sign.
TEST_P(Distribute, HasTheMetricsOfASingleRank) {
  const Subdomain domain = distributed();
  const Subdomain whole = distribute(mesh, Communicator(MPI_COMM_SELF));
  ASSERT_EQ(whole.owned_cells, static_cast<Index>(mesh.cells.size()));
  ASSERT_EQ(whole.total_cells, whole.interior_cells);

  std::vector<std::size_t> whole_cell(mesh.cells.size());
  for (std::size_t cell = 0; cell < mesh.cells.size(); ++cell) whole_cell[whole.cell_ids[cell]] = cell;
  for (std::size_t cell = 0; cell < domain.cell_ids.size(); ++cell) {
    const std::size_t other = whole_cell[domain.cell_ids[cell]];
    EXPECT_EQ(domain.volume[cell], whole.volume[other]);
    EXPECT_TRUE(same(domain.center[cell], whole.center[other]));
  }

  std::map<std::pair<GlobalIndex, GlobalIndex>, std::size_t> whole_face;
  for (std::size_t face = 0; face < whole.faces.size(); ++face)
    whole_face[{global_cell(whole, whole.faces[face].left), global_cell(whole, whole.faces[face].right)}] =
        face;
  for (std::size_t face = 0; face < domain.faces.size(); ++face) {
    const GlobalIndex left = global_cell(domain, domain.faces[face].left),
                      right = global_cell(domain, domain.faces[face].right);
    const bool turned = !whole_face.contains({left, right});
    const std::size_t other = whole_face.at(turned ? std::pair(right, left) : std::pair(left, right));
    EXPECT_TRUE(
        same(domain.face_normal[face], turned ? -whole.face_normal[other] : whole.face_normal[other]));
    EXPECT_TRUE(same(domain.face_center[face], whole.face_center[other]));
  }

  std::map<GlobalIndex, std::size_t> whole_boundary;
  for (std::size_t face = 0; face < whole.boundary_faces.size(); ++face)
    whole_boundary[whole.boundary_faces[face].id] = face;
  for (std::size_t face = 0; face < domain.boundary_faces.size(); ++face) {
    const std::size_t other = whole_boundary.at(domain.boundary_faces[face].id);
    EXPECT_TRUE(same(domain.boundary_normal[face], whole.boundary_normal[other]));
    EXPECT_TRUE(same(domain.boundary_center[face], whole.boundary_center[other]));
  }
}

// Each side of a face of a cell is a boundary face or one side of a face; cut faces are on two ranks.
TEST_P(Distribute, HasEveryFaceOnce) {
  const Subdomain domain = distributed();
  const auto inner = comm.sum(static_cast<GlobalIndex>(domain.cut_face_begin));
  const auto cut = comm.sum(static_cast<GlobalIndex>(domain.faces.size()) - domain.cut_face_begin);
  const auto boundary = comm.sum(static_cast<GlobalIndex>(domain.boundary_faces.size()));
  EXPECT_EQ(2 * inner + cut + boundary, 4 * static_cast<GlobalIndex>(mesh.cells.size()));
  EXPECT_TRUE(comm.size() > 1 || cut == 0);
}

// A linear map changes volumes by its determinant, here 2 * 3 * 0.5.
TEST_P(Distribute, UpdatesMetricsWhenPointsMove) {
  Subdomain domain = distributed();
  const auto before = domain.volume;
  for (Vec3& point : domain.points) point = {2 * point.x + point.y, 3 * point.y, 0.5 * point.z - point.x};
  domain.update_metrics();
  EXPECT_NO_THROW(domain.validate());
  for (std::size_t cell = 0; cell < before.size(); ++cell)
    EXPECT_NEAR(domain.volume[cell], 3 * before[cell], 1e-14);
}

TEST_P(Distribute, CountsItsBytes) {
  const Subdomain domain = distributed();
  EXPECT_GE(domain.bytes(), domain.points.size() * sizeof(Vec3) + domain.faces.size() * 60);
}

// The order that downstream_order promises: of two neighbours the upstream one has the smaller number.
TEST(DistributeOrder, GoesWithTheFlow) {
  const Communicator comm;
  const Subdomain domain = distribute(test_box(), comm);
  if (comm.size() > 1) GTEST_SKIP() << "cells that touch ghosts come last on several ranks";
  for (const auto& face : domain.faces)
    EXPECT_LE(domain.center[face.left].x, domain.center[face.right].x + 1e-9);
}

TEST(DistributeErrors, ReachAllRanks) {
  const Communicator comm;
  const Mesh tetrahedron{"one.msh",
                         {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
                         {{0, 1, 2, 3}},
                         {{"wall", {{0, 1, 2}, {0, 1, 3}, {0, 2, 3}, {1, 2, 3}}}}};
  if (comm.size() == 1) {
    EXPECT_NO_THROW(distribute(tetrahedron, comm).validate());
    return;
  }
  try {
    distribute(tetrahedron, comm);
    FAIL() << "more ranks than cells were accepted";
  } catch (const InputError& error) {
    EXPECT_EQ(error.problems().at(0).file, "one.msh");
    EXPECT_EQ(error.problems().at(0).what, std::to_string(comm.size()) + " ranks for 1 cells");
    EXPECT_FALSE(error.problems().at(0).remedy.empty());
  }
  EXPECT_THROW(distribute(tetrahedron, {0}, comm), InputError) << "a rank without cells";
}

TEST(DistributeErrors, RefuseOwnersThatDoNotFit) {
  const Communicator comm;
  const Mesh mesh = box_mesh({.cells = {2, 1, 1}});
  EXPECT_THROW(distribute(mesh, std::vector<int>(3, 0), comm), InputError);
  EXPECT_THROW(distribute(mesh, std::vector<int>(12, comm.size()), comm), InputError);
}

TEST(DistributeErrors, ReachAllRanksWhenAFaceIsBare) {
  const Communicator comm;
  Mesh mesh = test_box();
  mesh.patches[0].triangles.pop_back();
  EXPECT_THROW(distribute(mesh, comm), std::exception);
}

// validate() must notice each breach that a test makes in a sound subdomain.
TEST(SubdomainValidate, NoticesBreaches) {
  const Communicator comm;
  const Subdomain sound = distribute(test_box(), comm);
  const auto expect_noticed = [&](const char* what, auto&& breach) {
    Subdomain domain = sound;
    breach(domain);
    EXPECT_THROW(domain.validate(), std::logic_error) << what;
  };
  expect_noticed("volume", [](Subdomain& d) { d.volume[3] *= -1; });
  expect_noticed("normal", [](Subdomain& d) { d.face_normal[5] = -d.face_normal[5]; });
  expect_noticed("closure", [](Subdomain& d) { d.face_normal[5].x += 1e-9 * norm(d.face_normal[5]); });
  expect_noticed("boundary normal", [](Subdomain& d) { d.boundary_normal[2] = -d.boundary_normal[2]; });
  expect_noticed("missing face", [](Subdomain& d) {
    d.boundary_faces.pop_back();
    d.boundary_normal.pop_back();
    d.boundary_center.pop_back();
  });
  expect_noticed("face order", [](Subdomain& d) { std::swap(d.faces[0], d.faces[1]); });
  expect_noticed("boundary order",
                 [](Subdomain& d) { std::swap(d.boundary_faces.front(), d.boundary_faces.back()); });
  expect_noticed("cell ids", [](Subdomain& d) { d.cell_ids[1] = d.cell_ids[0]; });
  expect_noticed("point ids", [](Subdomain& d) { d.point_ids[1] = d.global_points; });
  expect_noticed("interior", [](Subdomain& d) { --d.interior_cells; });
  expect_noticed("cells of faces", [](Subdomain& d) { d.cell_faces.items[0] = d.cell_faces.items.back(); });
  expect_noticed("cells of points", [](Subdomain& d) { d.point_cells.items[0] = d.point_cells.items[1]; });
  expect_noticed("sizes", [](Subdomain& d) { d.center.pop_back(); });
  if (sound.neighbours.empty()) return;
  expect_noticed("ghost range", [](Subdomain& d) { ++d.neighbours[0].ghost_begin; });
  expect_noticed("face ghosts", [](Subdomain& d) { --d.neighbours[0].ghost_face_count; });
  expect_noticed("sent cells", [](Subdomain& d) { d.neighbours[0].send[0] = d.owned_cells; });
}

// More than MPI counts is refused on every rank, before anything is sent; the numbers alone tell.
TEST(Delivery, TooManyItems) {
  const Communicator comm;
  std::vector<int> counts(static_cast<std::size_t>(comm.size()), 0);
  counts[0] = item_count(std::size_t{1} << 33);
  if (comm.rank() != comm.size() - 1) counts[0] = 0;
  try {
    deliver<char>({}, counts, comm);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("use more ranks"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace alphadot
