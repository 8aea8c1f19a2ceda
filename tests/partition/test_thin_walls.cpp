// open_thin_walls(). Expectations: sheets between the cubes of a box mesh, whose triangles, edges and corners
// can be counted; a mesh that is sound by Mesh::validate() after it was opened.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <random>

#include "core/error.hpp"
#include "partition/thin_walls.hpp"
#include "support/box_mesh.hpp"

namespace alphadot {
namespace {

using testing::HasSubstr;

/// A box of 4 x 4 x 4 cubes of length 1.
Mesh box() {
  return testing_support::box_mesh({.cells = {4, 4, 4}, .upper = {4, 4, 4}});
}

/// The faces of cells in the plane of that coordinate, with centres for which `is_part` holds, each once.
Patch sheet(const Mesh& mesh, const std::string& name, int axis, Real at,
            const std::function<bool(const Vec3&)>& is_part) {
  Patch out{name, {}};
  for (const auto& cell : mesh.cells)
    for (std::size_t opposite = 0; opposite < 4; ++opposite) {
      std::array<GlobalIndex, 3> face;
      Vec3 center, apex = mesh.points[static_cast<std::size_t>(cell[opposite])];
      bool is_in_plane = true;
      for (std::size_t i = 0, k = 0; i < 4; ++i) {
        if (i == opposite) continue;
        face[k++] = cell[i];
        const Vec3& place = mesh.points[static_cast<std::size_t>(cell[i])];
        is_in_plane = is_in_plane && place[axis] == at;
        center += (1.0 / 3) * place;
      }
      if (is_in_plane && apex[axis] > at && is_part(center)) out.triangles.push_back(face);
    }
  return out;
}

Real area_of(const Mesh& mesh, const Patch& patch) {
  Real out = 0;
  for (const auto& [a, b, c] : patch.triangles)
    out += norm(cross(mesh.points[static_cast<std::size_t>(b)] - mesh.points[static_cast<std::size_t>(a)],
                      mesh.points[static_cast<std::size_t>(c)] - mesh.points[static_cast<std::size_t>(a)])) /
           2;
  return out;
}

Real volume_of(const Mesh& mesh) {
  Real out = 0;
  for (const auto& [a, b, c, d] : mesh.cells) {
    const auto at = [&](GlobalIndex point) { return mesh.points[static_cast<std::size_t>(point)]; };
    out += dot(cross(at(b) - at(a), at(c) - at(a)), at(d) - at(a)) / 6;
  }
  return out;
}

/// Sums the area vectors that point out of the flow: zero for a wall with two sides.
Vec3 net_area(const Mesh& mesh, const Patch& patch) {
  Vec3 out;
  for (const auto& [a, b, c] : patch.triangles)
    out += cross(mesh.points[static_cast<std::size_t>(b)] - mesh.points[static_cast<std::size_t>(a)],
                 mesh.points[static_cast<std::size_t>(c)] - mesh.points[static_cast<std::size_t>(a)]);
  return out;
}

std::string defect(const Mesh& mesh) {
  try {
    mesh.validate();
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

std::vector<std::string> open(Mesh& mesh, const std::vector<std::string>& names) {
  return open_thin_walls(mesh, names);
}

TEST(ThinWalls, ASheetInTheFlowGetsTwoSides) {
  Mesh mesh = box();
  // Two by two squares, z = 2: eight triangles, one inner point, eight on the free edge.
  mesh.patches.push_back(
      sheet(mesh, "fin", 2, 2, [](const Vec3& at) { return at.x > 1 && at.x < 3 && at.y > 1 && at.y < 3; }));
  ASSERT_EQ(mesh.patches[6].triangles.size(), 8u);
  ASSERT_THAT(defect(mesh), HasSubstr("lies between two cells (8 such cases)"));
  const Mesh before = mesh;
  const auto notes = open(mesh, {"fin"});
  EXPECT_EQ(defect(mesh), "");
  EXPECT_NEAR(area_of(mesh, mesh.patches[6]), 2 * 4, 1e-12);
  EXPECT_NEAR(norm(net_area(mesh, mesh.patches[6])), 0, 1e-12);
  EXPECT_NEAR(volume_of(mesh), 64, 1e-12);
  // The squares' diagonals run one way: at two corners of the sheet a triangle has free edges all round.
  EXPECT_THAT(notes,
              testing::ElementsAre("patch \"fin\": 8 triangles inside the mesh are a wall with two sides",
                                   HasSubstr("2 triangles of walls with two sides")));
  EXPECT_EQ(mesh.cells.size(), before.cells.size() + 2 * 2 * 2);
  EXPECT_EQ(mesh.patches[6].triangles.size(), 2 * (8 + 2 * 2));
  // The middle of each cut triangle, and the inner point and these once more.
  EXPECT_EQ(mesh.points.size(), before.points.size() + 2 + 3);
  for (std::size_t i = 0; i < 6; ++i) EXPECT_EQ(mesh.patches[i].triangles, before.patches[i].triangles);
}

/// Other programs list such a sheet once for each side: in one patch, or in a patch a side.
TEST(ThinWalls, ASheetThatIsListedFromBothSides) {
  Mesh mesh = box();
  mesh.patches.push_back(
      sheet(mesh, "fin", 2, 2, [](const Vec3& at) { return at.x > 1 && at.x < 3 && at.y > 1 && at.y < 3; }));
  Mesh once = mesh;
  auto turned = mesh.patches[6];
  for (auto& triangle : turned.triangles) std::swap(triangle[0], triangle[1]);
  Mesh in_two = mesh;
  auto& all = mesh.patches[6].triangles;
  all.insert(all.end(), turned.triangles.begin(), turned.triangles.end());
  EXPECT_THAT(open(mesh, {"fin"}),
              testing::Contains("patch \"fin\": 8 triangles that are listed twice are taken once"));
  open(once, {"fin"});
  EXPECT_EQ(mesh.hash(), once.hash());

  turned.name = "low";
  in_two.patches.push_back(turned);
  for (const auto& thin : std::vector<std::vector<std::string>>{{}, {"fin"}, {"fin", "low"}}) {
    Mesh tried = in_two;
    open(tried, thin);
    EXPECT_THAT(defect(tried),
                HasSubstr("covers a face that a triangle of patch \"fin\" covers too (8 such cases)"));
    EXPECT_THAT(defect(tried), HasSubstr("put each surface in one patch only, and once"));
    EXPECT_THAT(defect(tried), testing::Not(HasSubstr("lies between")));
  }
}

TEST(ThinWalls, ASheetOfOneTriangle) {
  Mesh mesh = box();
  mesh.patches.push_back(
      sheet(mesh, "fin", 2, 2, [](const Vec3& at) { return at.x > 1 && at.x < 2 && at.y > 1 && at.y < 2; }));
  mesh.patches[6].triangles.resize(1);
  open(mesh, {"fin"});
  EXPECT_EQ(defect(mesh), "");
  EXPECT_NEAR(area_of(mesh, mesh.patches[6]), 2 * 0.5, 1e-12);
}

TEST(ThinWalls, ASheetOnAWallPartsTheTrianglesThere) {
  Mesh mesh = box();
  // From the side y = 0, as a fin in half a model.
  mesh.patches.push_back(
      sheet(mesh, "fin", 2, 2, [](const Vec3& at) { return at.x > 1 && at.x < 3 && at.y < 2; }));
  open(mesh, {"fin"});
  EXPECT_EQ(defect(mesh), "");
  EXPECT_NEAR(area_of(mesh, mesh.patches[6]), 2 * 4, 1e-12);
  EXPECT_NEAR(area_of(mesh, mesh.patches[2]), 16, 1e-12);
  // Above and below the root no point is shared but those of the two free edges there.
  const auto point_at = [&](const Vec3& place) {
    return std::ranges::count_if(mesh.points, [&](const Vec3& at) { return norm(at - place) < 1e-12; });
  };
  EXPECT_EQ(point_at({2, 0, 2}), 2);
  EXPECT_EQ(point_at({1, 0, 2}), 1);
  EXPECT_EQ(point_at({3, 0, 2}), 1);
  EXPECT_EQ(point_at({2, 2, 2}), 1);
}

TEST(ThinWalls, CrossingSheetsOfOneOrSeveralPatches) {
  for (const bool is_one : {true, false}) {
    Mesh mesh = box();
    const auto middle = [](const Vec3& at) {
      return at.x > 1 && at.x < 3 && at.y > 1 && at.y < 3 && at.z > 1 && at.z < 3;
    };
    Patch across = sheet(mesh, "across", 1, 2, middle), along = sheet(mesh, "along", 2, 2, middle);
    if (is_one) {
      across.triangles.insert(across.triangles.end(), along.triangles.begin(), along.triangles.end());
      mesh.patches.push_back(across);
      open(mesh, {"across"});
      EXPECT_NEAR(area_of(mesh, mesh.patches[6]), 2 * 8, 1e-12);
    } else {
      mesh.patches.push_back(across);
      mesh.patches.push_back(along);
      open(mesh, {"along", "across"});
      EXPECT_NEAR(area_of(mesh, mesh.patches[6]), 2 * 4, 1e-12);
      EXPECT_NEAR(area_of(mesh, mesh.patches[7]), 2 * 4, 1e-12);
    }
    EXPECT_EQ(defect(mesh), "");
    // The middle of the cross has a point in each quarter.
    EXPECT_EQ(std::ranges::count_if(mesh.points,
                                    [](const Vec3& at) {
                                      return norm(at - Vec3{2, 2, 2}) < 1e-12;
                                    }),
              4);
  }
}

TEST(ThinWalls, TheRestOfThePatchStays) {
  Mesh mesh = box();
  const auto fin = sheet(mesh, "fin", 2, 2, [](const Vec3& at) { return at.x > 1 && at.x < 3 && at.y < 2; });
  auto& wall = mesh.patches[2].triangles;
  wall.insert(wall.end(), fin.triangles.begin(), fin.triangles.end());
  open(mesh, {"y_min"});
  EXPECT_EQ(defect(mesh), "");
  EXPECT_NEAR(area_of(mesh, mesh.patches[2]), 16 + 2 * 4, 1e-12);
}

TEST(ThinWalls, CutCellsStayInTheirVolumes) {
  Mesh mesh = box();
  const auto half = static_cast<GlobalIndex>(mesh.cells.size() / 2);
  mesh.volumes = {{"below", 0}, {"above", half}};
  mesh.patches.push_back(
      sheet(mesh, "fin", 2, 2, [](const Vec3& at) { return at.x < 2 && at.x > 1 && at.y > 1 && at.y < 2; }));
  open(mesh, {"fin"});
  EXPECT_GT(std::ssize(mesh.cells), 2 * half);
  for (GlobalIndex cell = 0; cell < std::ssize(mesh.cells); ++cell) {
    Vec3 center;
    for (const GlobalIndex point : mesh.cells[static_cast<std::size_t>(cell)])
      center += 0.25 * mesh.points[static_cast<std::size_t>(point)];
    EXPECT_EQ(mesh.volume_of(cell), center.z < 2 ? "below" : "above");
  }
}

TEST(ThinWalls, ASurfaceThatPartsTheMeshIsLeftForValidation) {
  Mesh mesh = box();
  mesh.patches.push_back(sheet(mesh, "across", 2, 2, [](const Vec3&) { return true; }));
  const auto hash = mesh.hash();
  open(mesh, {"across"});
  EXPECT_EQ(mesh.hash(), hash);
  EXPECT_THAT(defect(mesh), HasSubstr("it is a wall between the 192 cells"));
}

TEST(ThinWalls, OtherInnerSurfacesStayWhole) {
  // A fin beside one that is not named, and beside a wall between two parts.
  for (const bool parts : {false, true}) {
    Mesh mesh = box();
    mesh.patches.push_back(sheet(mesh, "fin", 2, 2, [](const Vec3& at) { return at.x > 1 && at.x < 2; }));
    mesh.patches.push_back(
        sheet(mesh, "other", 0, 2, [&](const Vec3& at) { return parts || (at.z > 1 && at.z < 3); }));
    const auto other = mesh.patches[7].triangles;
    open(mesh, parts ? std::vector<std::string>{"fin", "other"} : std::vector<std::string>{"fin"});
    EXPECT_THAT(defect(mesh), HasSubstr(parts ? "it is a wall between" : "patch \"other\""));
    EXPECT_THAT(defect(mesh), HasSubstr("(" + std::to_string(other.size()) + " such cases)"));
    EXPECT_THAT(defect(mesh), testing::Not(HasSubstr("is not a face")));
    EXPECT_NEAR(area_of(mesh, mesh.patches[6]), 2 * 4, 1e-12);
  }
}

/// Any set of inner faces: the mesh is sound then and has both sides of each, or the walls part it and
/// validation says so.
TEST(ThinWalls, RandomSetsOfFaces) {
  const Mesh cubes = testing_support::box_mesh({.cells = {3, 3, 3}, .upper = {3, 3, 3}});
  std::map<std::array<GlobalIndex, 3>, int> sides;
  for (const auto& cell : cubes.cells)
    for (std::size_t i = 0; i < 4; ++i) {
      std::array face{cell[(i + 1) % 4], cell[(i + 2) % 4], cell[(i + 3) % 4]};
      std::ranges::sort(face);
      ++sides[face];
    }
  std::vector<std::array<GlobalIndex, 3>> inner;
  for (const auto& [face, count] : sides)
    if (count == 2) inner.push_back(face);
  std::mt19937 random(20261130);
  int opened = 0, parted = 0;
  for (int set = 0; set < 2000; ++set) {
    SCOPED_TRACE(testing::Message() << "set " << set);
    Mesh mesh = cubes;
    mesh.patches.push_back({"fin", {}});
    mesh.patches.push_back({"wing", {}});
    // From a few faces to nearly all of them, which encloses cells.
    const unsigned share = 1 + random() % (set % 2 == 0 ? 10 : 100);
    for (const auto& face : inner)
      if (random() % 100 < share) mesh.patches[6 + random() % 2].triangles.push_back(face);
    if (mesh.patches[6].triangles.empty() || mesh.patches[7].triangles.empty()) continue;
    const Real area = area_of(mesh, mesh.patches[6]) + area_of(mesh, mesh.patches[7]);
    open(mesh, {"fin", "wing"});
    const std::string found = defect(mesh);
    if (found.empty()) {
      EXPECT_NEAR(area_of(mesh, mesh.patches[6]) + area_of(mesh, mesh.patches[7]), 2 * area, 1e-9);
      ++opened;
    } else {
      EXPECT_THAT(found, HasSubstr("it is a wall between"));
      EXPECT_THAT(found, testing::Not(HasSubstr("is not a face")));
      EXPECT_THAT(found, testing::Not(HasSubstr("neither a second cell")));
      ++parted;
    }
    EXPECT_NEAR(volume_of(mesh), 27, 1e-9);
    if (testing::Test::HasFailure()) return;
  }
  EXPECT_GT(opened, 500);
  EXPECT_GT(parted, 100);
}

TEST(ThinWalls, WrongNamesAreTold) {
  Mesh mesh = box();
  const auto error = [&](const std::string& name) -> std::string {
    try {
      open(mesh, {name});
    } catch (const InputError& e) {
      return e.what();
    }
    return "";
  };
  EXPECT_THAT(error("fim"), testing::AllOf(HasSubstr("mesh.thin names \"fim\", which the mesh does not have"),
                                           HasSubstr("x_min, x_max")));
  EXPECT_THAT(error("x_min"), HasSubstr("mesh.thin names \"x_min\", which has nothing inside the mesh"));
}

}  // namespace
}  // namespace alphadot
