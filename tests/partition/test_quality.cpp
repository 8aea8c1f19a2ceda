// The worst cells of a mesh. Expectations: angles, heights and volumes of cells that are known by hand, and
// the same mesh on one rank alone.
#include <gtest/gtest.h>

#include <cmath>

#include "parallel.hpp"
#include "partition/geometry.hpp"
#include "partition/quality.hpp"
#include "partition/subdomain.hpp"

namespace alphadot {
namespace {

using testing_support::box_mesh;
using testing_support::random_owners;

TEST(TetrahedronShape, OfARegularOne) {
  const auto shape =
      tetrahedron_shape({Vec3{1, 1, 1}, Vec3{1, -1, -1}, Vec3{-1, 1, -1}, Vec3{-1, -1, 1}}, {3, 0, 2, 1});
  EXPECT_NEAR(shape.smallest_angle, std::acos(1.0 / 3) / radians_per_degree, 1e-12);
  EXPECT_NEAR(shape.aspect_ratio, 1, 1e-14);
}

TEST(TetrahedronShape, OfASixthOfACube) {
  // Faces meet at 45, 60 and 90 degrees; the longest edge is sqrt(3), the smallest height 1 / sqrt(2).
  const auto shape =
      tetrahedron_shape({Vec3{0, 0, 0}, Vec3{1, 0, 0}, Vec3{1, 1, 0}, Vec3{1, 1, 1}}, {0, 1, 2, 3});
  EXPECT_NEAR(shape.smallest_angle, 45, 1e-12);
  EXPECT_NEAR(shape.aspect_ratio, 2, 1e-14);  // sqrt(2/3) sqrt(3) sqrt(2)
}

TEST(TetrahedronShape, OfASliver) {
  // A square whose diagonals are 2 e apart: along its sides meet planes of the normals (a, -a, 1) and (a, a,
  // 1), where a = 2 e.
  const Real e = 1e-3;
  const auto shape =
      tetrahedron_shape({Vec3{0, 0, e}, Vec3{1, 1, e}, Vec3{1, 0, -e}, Vec3{0, 1, -e}}, {0, 1, 2, 3});
  const Real a = 2 * e;
  EXPECT_NEAR(shape.smallest_angle, std::acos(1 / (1 + 2 * a * a)) / radians_per_degree, 1e-9);
}

TEST(MeshQuality, NamesTheWorstCells) {
  const Communicator comm;
  // Layers of cubes, of thickness 1, 1, 1/4, 1: volumes step by four, and the flat cells are the worst.
  Mesh mesh = box_mesh({.cells = {1, 1, 4}, .lower = {0, 0, 0}, .upper = {1, 1, 4}});
  for (auto& point : mesh.points)
    if (point.z > 2) point.z -= 0.75;
  const auto quality = mesh_quality(distribute(mesh, random_owners(mesh, comm.size()), comm), comm);
  EXPECT_NEAR(quality.volume_ratio.value, 4, 1e-12);
  // Cell (0, 0, 0) (1, 0, 0) (1, 1, 0) (1, 1, h) and its kin: the faces z = 0 and through the long edge meet
  // at atan(h), and the longest edge sqrt(2 + h^2) stands over the height h / sqrt(1 + h^2).
  const Real h = 0.25;
  EXPECT_NEAR(quality.smallest_angle.value, std::atan(h) / radians_per_degree, 1e-10);
  EXPECT_NEAR(quality.aspect_ratio.value, std::sqrt(2.0 / 3 * (2 + h * h) * (1 + h * h)) / h, 1e-10);
  for (const auto& worst : {quality.smallest_angle, quality.aspect_ratio, quality.volume_ratio}) {
    EXPECT_GE(worst.id, 12);
    EXPECT_LT(worst.id, 18);
    EXPECT_NEAR(worst.at.z, 2.125, 0.125);
  }
}

TEST(MeshQuality, IsTheSameToTheLastBitOnAnyPartition) {
  const Communicator comm;
  const Mesh mesh = testing_support::test_box();
  const auto together = mesh_quality(distribute(mesh, random_owners(mesh, comm.size()), comm), comm);
  const Communicator self(MPI_COMM_SELF);
  const auto alone = mesh_quality(distribute(mesh, self), self);
  const auto expect_same = [](const WorstCell& a, const WorstCell& b) {
    EXPECT_EQ(a.value, b.value);
    EXPECT_EQ(a.id, b.id);
    for (int d = 0; d < 3; ++d) EXPECT_EQ(a.at[d], b.at[d]);
  };
  expect_same(together.smallest_angle, alone.smallest_angle);
  expect_same(together.aspect_ratio, alone.aspect_ratio);
  expect_same(together.volume_ratio, alone.volume_ratio);
}

}  // namespace
}  // namespace alphadot
