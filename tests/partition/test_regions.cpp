// Regions of a mesh that share no face. Expectations: boxes put beside each other, whose cells are counted.
#include <gtest/gtest.h>

#include <algorithm>

#include "parallel.hpp"
#include "partition/mesh_part.hpp"
#include "partition/regions.hpp"
#include "partition/subdomain.hpp"

namespace alphadot {
namespace {

using testing_support::box_mesh;
using testing_support::random_owners;

/// Both meshes as one, without a common point.
Mesh beside(Mesh a, const Mesh& b) {
  const auto first = static_cast<GlobalIndex>(a.points.size());
  a.points.insert(a.points.end(), b.points.begin(), b.points.end());
  for (auto cell : b.cells) {
    for (auto& point : cell) point += first;
    a.cells.push_back(cell);
  }
  for (std::size_t patch = 0; patch < b.patches.size(); ++patch)
    for (auto triangle : b.patches[patch].triangles) {
      for (auto& point : triangle) point += first;
      a.patches[patch].triangles.push_back(triangle);
    }
  return a;
}

/// By METIS and on random owners, whose parts fall into hundreds of pieces.
class RegionsOfMesh : public testing::TestWithParam<bool> {
 protected:
  Subdomain distributed(const Mesh& mesh) const {
    return GetParam() ? distribute(mesh, random_owners(mesh, comm.size()), comm) : distribute(mesh, comm);
  }
  const Communicator comm;
};

void expect_box(const Box& box, const Vec3& lower, const Vec3& upper) {
  for (int d = 0; d < 3; ++d) {
    EXPECT_EQ(box.lower[d], lower[d]);
    EXPECT_EQ(box.upper[d], upper[d]);
  }
}

TEST_P(RegionsOfMesh, AreOneWhereTheMeshHangsTogether) {
  const auto domain = distributed(testing_support::test_box());
  const auto regions = find_regions(domain, comm);
  ASSERT_EQ(regions.all.size(), 1u);
  EXPECT_EQ(regions.all[0].cells, 6 * 7 * 5 * 4);
  EXPECT_EQ(regions.all[0].first_cell, 0);
  expect_box(regions.all[0].box, {-1, 0, 2}, {2.5, 1.2, 3});
  EXPECT_EQ(regions.of_cell, std::vector<Index>(static_cast<std::size_t>(domain.owned_cells), 0));
}

TEST_P(RegionsOfMesh, AreToldApartWithTheLargestFirst) {
  const Mesh small = box_mesh({.cells = {2, 2, 2}, .lower = {5, 0, 0}, .upper = {6, 1, 1}});
  const Mesh large = box_mesh({.cells = {4, 3, 3}});
  const Mesh other = box_mesh({.cells = {2, 2, 2}, .lower = {7, 0, 0}, .upper = {8, 1, 1}});
  const auto domain = distributed(beside(beside(small, large), other));
  const auto regions = find_regions(domain, comm);
  ASSERT_EQ(regions.all.size(), 3u);
  EXPECT_EQ(regions.all[0].cells, 6 * 4 * 3 * 3);
  EXPECT_EQ(regions.all[0].first_cell, 48);
  expect_box(regions.all[0].box, {0, 0, 0}, {1, 1, 1});
  // Equally large: in the order of the file.
  EXPECT_EQ(regions.all[1].first_cell, 0);
  expect_box(regions.all[1].box, {5, 0, 0}, {6, 1, 1});
  EXPECT_EQ(regions.all[2].first_cell, 48 + 216);
  for (Index cell = 0; cell < domain.owned_cells; ++cell)
    EXPECT_EQ(regions.of_cell[cell], domain.center[cell].x < 2 ? 0 : domain.center[cell].x < 6.5 ? 1 : 2);
}

TEST_P(RegionsOfMesh, AreNotJoinedByPointsAndEdges) {
  Mesh mesh = beside(box_mesh({.cells = {2, 2, 2}}),
                     box_mesh({.cells = {2, 2, 2}, .lower = {1, 1, 0}, .upper = {2, 2, 1}}));
  for (auto& cell : mesh.cells)  // the points of the edge x = y = 1 become common ones
    for (auto& point : cell)
      if (point >= 27 && mesh.points[point].x == 1 && mesh.points[point].y == 1)
        point = 8 + 9 * static_cast<GlobalIndex>(2 * mesh.points[point].z);
  for (auto& patch : mesh.patches)
    for (auto& triangle : patch.triangles)
      for (auto& point : triangle)
        if (point >= 27 && mesh.points[point].x == 1 && mesh.points[point].y == 1)
          point = 8 + 9 * static_cast<GlobalIndex>(2 * mesh.points[point].z);
  mesh.validate();
  EXPECT_EQ(find_regions(distributed(mesh), comm).all.size(), 2u);
}

INSTANTIATE_TEST_SUITE_P(Parts, RegionsOfMesh, testing::Bool(),
                         [](const auto& random) { return random.param ? "random" : "metis"; });

}  // namespace
}  // namespace alphadot
