// Mesh::validate() and Mesh::hash(). Expectations: each test breaks a sound box mesh in one known place.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <set>
#include <string>
#include <utility>

#include "core/error.hpp"
#include "partition/mesh.hpp"
#include "support/box_mesh.hpp"

namespace alphadot {
namespace {

using testing_support::box_mesh;

/// The message that validate() throws; empty when it does not.
std::string defect(const Mesh& mesh) {
  try {
    mesh.validate();
  } catch (const InputError& error) {
    for (const auto& problem : error.problems()) {
      EXPECT_EQ(problem.file, mesh.file);
      EXPECT_FALSE(problem.remedy.empty());
    }
    return error.what();
  }
  return "";
}

void expect_defect(const Mesh& mesh, const std::string& what) {
  EXPECT_NE(defect(mesh).find(what), std::string::npos) << defect(mesh);
}

TEST(BoxMesh, HasSixCellsACubeAndTwoTrianglesASquare) {
  const Mesh mesh = box_mesh({.cells = {2, 3, 4}});
  EXPECT_EQ(mesh.cells.size(), 6u * 2 * 3 * 4);
  EXPECT_EQ(mesh.points.size(), 3u * 4 * 5);
  ASSERT_EQ(mesh.patches.size(), 6u);
  EXPECT_EQ(mesh.patches[0].name, "x_min");
  EXPECT_EQ(mesh.patches[0].triangles.size(), 2u * 3 * 4);
  EXPECT_EQ(mesh.patches[5].name, "z_max");
  EXPECT_EQ(mesh.patches[5].triangles.size(), 2u * 2 * 3);
}

TEST(BoxMesh, StaysSoundWhenPerturbedByItsLimit) {
  for (std::uint32_t seed = 1; seed <= 20; ++seed)
    EXPECT_EQ(defect(box_mesh({.cells = {6, 5, 4}, .perturbation = 0.16, .seed = seed})), "");
}

TEST(MeshValidate, AcceptsASoundMesh) {
  EXPECT_EQ(defect(box_mesh()), "");
}

TEST(MeshValidate, RejectsAnEmptyMesh) {
  expect_defect(Mesh{"empty", {}, {}, {}}, "no tetrahedra");
}

TEST(MeshValidate, RejectsPointsThatAreNotFinite) {
  Mesh mesh = box_mesh();
  mesh.points[7].y = std::numeric_limits<Real>::quiet_NaN();
  mesh.points[9].x = std::numeric_limits<Real>::infinity();
  expect_defect(mesh, "point 8 at (0.5, nan, 0) is not finite (2 such points)");
}

TEST(MeshValidate, RejectsPointIdsOutOfRange) {
  Mesh mesh = box_mesh();  // 125 points
  mesh.cells[2][1] = 125;
  mesh.cells[5][0] = -1;
  expect_defect(mesh, "there are points 1 to 125 only (2 such cells)");
  mesh = box_mesh();
  mesh.patches[1].triangles[0][2] = 125;
  expect_defect(mesh, "boundary triangle 33 has the points");  // 32 triangles in the first patch
}

TEST(MeshValidate, RejectsRepeatedPoints) {
  Mesh mesh = box_mesh();
  mesh.cells[3][1] = mesh.cells[3][0];
  expect_defect(mesh, "cell 4 has the points 1 1 ");
  mesh = box_mesh();
  mesh.patches[0].triangles[4][1] = mesh.patches[0].triangles[4][0];
  expect_defect(mesh, "boundary triangle 5 has the points");
}

TEST(MeshValidate, RejectsNegativeAndZeroVolumes) {
  Mesh mesh = box_mesh();
  std::swap(mesh.cells[10][0], mesh.cells[10][1]);
  expect_defect(mesh, "cell 11 at ");
  expect_defect(mesh, "has no positive volume (1 such cases)");
  mesh = box_mesh({.cells = {1, 1, 1}});
  for (auto& point : mesh.points) point.z = 0;
  expect_defect(mesh, "of volume 0, has no positive volume (6 such cases)");
}

TEST(MeshValidate, RejectsAFaceOfThreeCells) {
  Mesh mesh = box_mesh();
  mesh.cells.push_back(mesh.cells[100]);
  expect_defect(mesh, "cell 101 at ");
  expect_defect(mesh, "shares a face with two or more other cells");
}

TEST(MeshValidate, RejectsCellsOnTheSameSideOfAFace) {
  // Two tetrahedra on the triangle 1 2 3, both with their apex above it; the other six faces are covered.
  const Mesh mesh{"two",
                  {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0.2, 0.2, 1}},
                  {{0, 1, 2, 3}, {0, 1, 2, 4}},
                  {{"wall", {{0, 1, 3}, {1, 2, 3}, {2, 0, 3}, {0, 1, 4}, {1, 2, 4}, {2, 0, 4}}}}};
  expect_defect(mesh, "cell 1 at (0.25, 0.25, 0.25), of volume 0.166667, lies on the same side");
}

TEST(MeshValidate, RejectsAnUncoveredFace) {
  Mesh mesh = box_mesh();
  mesh.patches[2].triangles.resize(mesh.patches[2].triangles.size() - 3);
  expect_defect(mesh, "neither a second cell nor a boundary triangle (3 such cases)");
}

TEST(MeshValidate, RejectsATriangleGivenTwice) {
  Mesh mesh = box_mesh();
  mesh.patches[3].triangles.push_back(mesh.patches[0].triangles[0]);
  expect_defect(mesh, "triangle 33 of patch \"y_max\"");
  expect_defect(mesh, " covers too (1 such cases)");
}

TEST(MeshValidate, RejectsATriangleBetweenTwoCells) {
  Mesh mesh = box_mesh({.cells = {1, 1, 1}});
  mesh.patches[4].triangles.push_back({0, 1, 7});  // has the diagonal 0-7, which is inside
  expect_defect(mesh,
                "triangle 3 of patch \"z_min\" at (0.666667, 0.333333, 0.333333) lies between two cells");
}

TEST(MeshValidate, TellsABodyWithoutThicknessFromOneThatIsMeshedInside) {
  Mesh sheet = box_mesh({.cells = {2, 3, 3}});
  Patch fin{"fin", {}}, across{"across", {}};
  for (auto triangle : sheet.patches[0].triangles) {
    for (auto& point : triangle) ++point;  // from x = 0 to x = 1/2
    across.triangles.push_back(triangle);
  }
  fin.triangles = {across.triangles[8], across.triangles[9]};  // a square with the flow all around
  Mesh parted = sheet;
  sheet.patches.push_back(fin);
  expect_defect(
      sheet,
      "lies between two cells (2 such cases); a body that has no thickness becomes a wall with two sides");
  // From wall to wall the same surface parts the mesh.
  parted.patches.push_back(across);
  expect_defect(
      parted,
      "it is a wall between the 54 cells from (0, 0, 0) to (0.5, 1, 1) and the 54 cells from (0.5, 0, "
      "0) to (1, 1, 1)");
  expect_defect(parted, "leave the one that is not the flow out of the mesh");
}

TEST(MeshValidate, NamesTheVolumesOnBothSidesOfAWall) {
  // The cube in the middle of 27 is the inside of a body; below it another one is, of two volumes.
  Mesh mesh = box_mesh({.cells = {3, 3, 3}, .upper = {3, 3, 3}});
  const auto cube_of = [&](std::size_t cell) {
    Vec3 out;
    for (const auto point : mesh.cells[cell]) out += 0.25 * mesh.points[static_cast<std::size_t>(point)];
    return std::array{static_cast<int>(out.x), static_cast<int>(out.y), static_cast<int>(out.z)};
  };
  Patch skin{"skin", {}};
  std::map<std::array<GlobalIndex, 3>, std::vector<std::size_t>> cells_of_face;
  for (std::size_t cell = 0; cell < mesh.cells.size(); ++cell)
    for (std::size_t i = 0; i < 4; ++i) {
      std::array face{mesh.cells[cell][(i + 1) % 4], mesh.cells[cell][(i + 2) % 4],
                      mesh.cells[cell][(i + 3) % 4]};
      std::ranges::sort(face);
      cells_of_face[face].push_back(cell);
    }
  for (const auto& [face, cells] : cells_of_face) {
    const auto is_body = [&](std::size_t cell) { return cube_of(cell) == std::array{1, 1, 1}; };
    if (cells.size() == 2 && is_body(cells[0]) != is_body(cells[1])) skin.triangles.push_back(face);
  }
  ASSERT_EQ(skin.triangles.size(), 12u);
  mesh.patches.push_back(skin);
  expect_defect(
      mesh, "it is a wall between the 156 cells from (0, 0, 0) to (3, 3, 3) and the 6 cells from (1, 1, 1)");
  expect_defect(mesh, "leave out of the mesh what is the inside of a body: the 6 cells");
  mesh.volumes = {{"air", 0}, {"solid", 6 * 13}, {"air", 6 * 14}};
  expect_defect(mesh,
                "it is a wall between volume \"air\" (156 cells from (0, 0, 0) to (3, 3, 3)) and volume "
                "\"solid\" (6 cells");
  expect_defect(mesh, "leave out of the mesh what is the inside of a body: volume \"solid\" (6 cells");
}

TEST(MeshValidate, RejectsATriangleOnNoCell) {
  Mesh mesh = box_mesh({.cells = {1, 1, 1}});
  mesh.patches[0].triangles.push_back({1, 2, 4});  // cuts a corner of the cube
  expect_defect(mesh, "triangle 3 of patch \"x_min\"");
  expect_defect(mesh, "is not a face of any cell (1 such cases)");
}

TEST(MeshValidate, ReportsAllDefectsOfAKindOfCheckAtOnce) {
  Mesh mesh = box_mesh();
  mesh.patches[2].triangles.pop_back();
  mesh.patches[0].triangles.push_back({0, 1, 124});
  expect_defect(mesh, "neither a second cell");
  expect_defect(mesh, "not a face of any cell");
}

TEST(MeshHash, DependsOnEveryPartOfTheMeshAndNothingElse) {
  const Mesh mesh = box_mesh();
  EXPECT_EQ(mesh.hash().size(), 16u);
  EXPECT_EQ(mesh.hash().find_first_not_of("0123456789abcdef"), std::string::npos);

  Mesh moved = mesh, reordered = mesh, renamed = mesh, repatched = mesh, elsewhere = mesh;
  moved.points[3].x += 1e-15;
  std::swap(reordered.cells[0], reordered.cells[1]);
  renamed.patches[0].name = "wall";
  repatched.patches[0].triangles.push_back(repatched.patches[1].triangles.front());
  repatched.patches[1].triangles.erase(repatched.patches[1].triangles.begin());
  elsewhere.file = "copy";
  EXPECT_EQ(elsewhere.hash(), mesh.hash());
  const std::set<std::string> hashes{mesh.hash(), moved.hash(), reordered.hash(), renamed.hash(),
                                     repatched.hash()};
  EXPECT_EQ(hashes.size(), 5u);
}

}  // namespace
}  // namespace alphadot
