// Elements cut into tetrahedra: every order of ids, collapsed, warped, turned and hopeless ones.
#include "io/element_cutting.hpp"

#include <gtest/gtest.h>

#include <map>
#include <numeric>
#include <set>

namespace alphadot {
namespace {

using Triangle = std::array<GlobalIndex, 3>;
using Tetrahedron = std::array<GlobalIndex, 4>;

constexpr std::array<Vec3, 8> cube{
    {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}}};
constexpr std::array<Vec3, 6> prism{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {0, 1, 1}}};
constexpr std::array<Vec3, 5> pyramid{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0.5, 0.5, 1}}};

/// The faces, as their shapes' definition has them; triangles repeat a corner. Any sense of rotation.
const std::map<std::size_t, std::vector<std::array<int, 4>>> faces{
    {8, {{0, 1, 2, 3}, {4, 5, 6, 7}, {0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}}},
    {6, {{0, 1, 2, 2}, {3, 4, 5, 5}, {0, 1, 4, 3}, {1, 2, 5, 4}, {2, 0, 3, 5}}},
    {5, {{0, 1, 2, 3}, {0, 1, 4, 4}, {1, 2, 4, 4}, {2, 3, 4, 4}, {3, 0, 4, 4}}}};

Triangle sorted(Triangle t) {
  std::sort(t.begin(), t.end());
  return t;
}

template <std::size_t n>
struct Case {
  std::vector<Vec3> points = std::vector<Vec3>(n);
  std::array<GlobalIndex, n> element;
  std::vector<Tetrahedron> cells;
  CuttingTally tally;

  /// The corners in places `corners`, with the ids of a permutation.
  Case(const std::array<Vec3, n>& corners, const std::array<GlobalIndex, n>& ids) : element(ids) {
    for (std::size_t i = 0; i < n; ++i) points[static_cast<std::size_t>(ids[i])] = corners[i];
    cut();
  }
  void cut() {
    cells.clear();
    tally = cut_elements<n>(std::span(&element, 1), points, cells);
  }

  Real volume() const {
    Real sum = 0;
    for (const auto& cell : cells) sum += volume_of(cell);
    return sum;
  }
  Real volume_of(const Tetrahedron& c) const {
    const auto at = [&](std::size_t i) { return points[static_cast<std::size_t>(c[i])]; };
    return dot(cross(at(1) - at(0), at(2) - at(0)), at(3) - at(0)) / 6;
  }
  /// Sides of the tetrahedra that only one of them has.
  std::set<Triangle> boundary() const {
    std::map<Triangle, int> count;
    for (const auto& c : cells)
      for (std::size_t i = 0; i < 4; ++i) ++count[sorted({c[(i + 1) % 4], c[(i + 2) % 4], c[(i + 3) % 4]})];
    std::set<Triangle> out;
    for (const auto& [triangle, times] : count) {
      EXPECT_LE(times, 2);
      if (times == 1) out.insert(triangle);
    }
    return out;
  }
  /// The element's faces, cut from their own smallest corner.
  std::set<Triangle> expected_boundary() const {
    std::set<Triangle> out;
    for (const auto& face : faces.at(n)) {
      std::array<GlobalIndex, 4> ids;
      for (std::size_t i = 0; i < 4; ++i) ids[i] = element[static_cast<std::size_t>(face[i])];
      if (ids[2] == ids[3]) {
        out.insert(sorted({ids[0], ids[1], ids[2]}));
        continue;
      }
      const auto k = static_cast<std::size_t>(std::min_element(ids.begin(), ids.end()) - ids.begin());
      out.insert(sorted({ids[k], ids[(k + 1) % 4], ids[(k + 2) % 4]}));
      out.insert(sorted({ids[k], ids[(k + 2) % 4], ids[(k + 3) % 4]}));
    }
    return out;
  }
};

/// Every order of the ids: positive tetrahedra that fill the element and meet its faces where both neighbours
/// cut them.
template <std::size_t n>
void try_all_orders(const std::array<Vec3, n>& corners, Real volume, std::size_t tetrahedra) {
  std::array<GlobalIndex, n> ids;
  std::iota(ids.begin(), ids.end(), GlobalIndex{0});
  do {
    const Case<n> c(corners, ids);
    ASSERT_EQ(c.cells.size(), tetrahedra);
    ASSERT_EQ(c.tally.with_inner_point, 0);
    for (const auto& cell : c.cells) ASSERT_GT(c.volume_of(cell), 0);
    ASSERT_NEAR(c.volume(), volume, 1e-14);
    ASSERT_EQ(c.boundary(), c.expected_boundary());
  } while (std::next_permutation(ids.begin(), ids.end()));
}

TEST(ElementCutting, EveryOrderOfIds) {
  try_all_orders(cube, 1, 6);
  try_all_orders(prism, 0.5, 3);
  try_all_orders(pyramid, 1.0 / 3, 2);
}

TEST(ElementCutting, QualityIsOneForIdealElements) {
  EXPECT_NEAR(Case<8>(cube, {0, 1, 2, 3, 4, 5, 6, 7}).tally.before.least, 1, 1e-15);
  const Real h = std::sqrt(0.75);
  EXPECT_NEAR(
      Case<6>({{{0, 0, 0}, {1, 0, 0}, {0.5, h, 0}, {0, 0, 1}, {1, 0, 1}, {0.5, h, 1}}}, {0, 1, 2, 3, 4, 5})
          .tally.before.least,
      1, 1e-15);
  EXPECT_NEAR(
      Case<5>({{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0.5, 0.5, std::sqrt(0.5)}}}, {0, 1, 2, 3, 4})
          .tally.before.least,
      1, 1e-15);
  // A cube twice as long as wide keeps its right angles; its six tetrahedra about a diagonal are the worse,
  // by hand: at (0,0,0) edges (1,0,0), (1,1,0), (1,1,2) make 2 / (1 sqrt 2 sqrt 6), over sqrt(1/2): 2 / sqrt
  // 6; the least is at its other end, where (1,1,2), (0,1,2), (0,0,2) make 2 / (sqrt 6 sqrt 5 2) sqrt 2 = 1 /
  // sqrt 15.
  std::array<Vec3, 8> tall = cube;
  for (Vec3& point : tall) point.z *= 2;
  const Case<8> c(tall, {0, 1, 2, 3, 4, 5, 6, 7});
  EXPECT_NEAR(c.tally.before.least, 1, 1e-15);
  EXPECT_NEAR(c.tally.after.least, std::sqrt(2.0) * 2 / (std::sqrt(6.0) * std::sqrt(5.0) * 2), 1e-15);
}

TEST(ElementCutting, LeftHandedElementsAreTurned) {
  const Case<8> c(cube, {4, 5, 6, 7, 0, 1, 2, 3});
  std::array<Vec3, 8> mirrored = cube;
  for (Vec3& point : mirrored) point.x = -point.x;
  const Case<8> left(mirrored, {0, 1, 2, 3, 4, 5, 6, 7});
  EXPECT_EQ(c.tally.left_handed, 0);
  EXPECT_EQ(left.tally.left_handed, 1);
  EXPECT_NEAR(left.volume(), 1, 1e-14);
  EXPECT_NEAR(left.tally.before.least, 1, 1e-15);
  for (const auto& cell : left.cells) EXPECT_GT(left.volume_of(cell), 0);
}

/// A hexahedron that is written with repeated corners is the prism, pyramid or tetrahedron that they leave.
TEST(ElementCutting, CollapsedElements) {
  const auto cut = [](std::array<GlobalIndex, 8> element, const std::vector<Vec3>& places) {
    std::vector<Vec3> points = places;
    std::vector<Tetrahedron> cells;
    const auto tally =
        cut_elements<8>(std::span<const std::array<GlobalIndex, 8>>(&element, 1), points, cells);
    Real volume = 0;
    for (const auto& c : cells) {
      const auto at = [&](std::size_t i) { return points[static_cast<std::size_t>(c[i])]; };
      const Real part = dot(cross(at(1) - at(0), at(2) - at(0)), at(3) - at(0)) / 6;
      EXPECT_GT(part, 0);
      volume += part;
    }
    return std::tuple(cells.size(), volume, tally.collapsed);
  };
  const std::vector<Vec3> p(prism.begin(), prism.end()), y(pyramid.begin(), pyramid.end());
  EXPECT_EQ(cut({0, 1, 2, 2, 3, 4, 5, 5}, p), std::tuple(3u, 0.5, 0));
  EXPECT_EQ(cut({0, 1, 2, 0, 3, 4, 5, 3}, p), std::tuple(3u, 0.5, 0));
  const auto [cells, volume, collapsed] = cut({0, 1, 2, 3, 4, 4, 4, 4}, y);
  EXPECT_EQ(cells, 2u);
  EXPECT_NEAR(volume, 1.0 / 3, 1e-15);
  EXPECT_EQ(cut({0, 1, 2, 2, 3, 3, 3, 3}, {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}),
            std::tuple(1u, 1.0 / 6, 0));
  EXPECT_EQ(cut({0, 1, 2, 3, 0, 1, 2, 3}, y), std::tuple(0u, 0.0, 1));
  EXPECT_EQ(cut({0, 0, 0, 0, 0, 0, 0, 0}, y), std::tuple(0u, 0.0, 1));
}

/// Two faces of the element in one plane: seen from a corner in both, one of them makes no volume; from a
/// point inside all of them do, and the faces are still cut as a neighbour would.
TEST(ElementCutting, AnInnerPointWhereACornerIsNotEnough) {
  std::array<Vec3, 8> flat = cube;
  flat[0] = {0.3, 0, 0};
  flat[1] = {0.7, 0, 0};
  flat[4] = {0, -1, 0};  // 0 1 5 4 lies in the plane of 0 1 2 3
  flat[5] = {1, -1, 0};
  const Case<8> c(flat, {3, 1, 2, 0, 4, 5, 6, 7});
  EXPECT_EQ(c.tally.with_inner_point, 1);
  ASSERT_EQ(c.points.size(), 9u);
  EXPECT_EQ(c.cells.size(), 12u);
  for (const auto& cell : c.cells) EXPECT_GT(c.volume_of(cell), 0);
  EXPECT_EQ(c.boundary(), c.expected_boundary());
}

TEST(ElementCutting, WhatIsTangledIsLeftForTheCheck) {
  std::array<Vec3, 8> tangled = cube;
  std::swap(tangled[5], tangled[6]);
  const Case<8> c(tangled, {0, 1, 2, 3, 4, 5, 6, 7});
  EXPECT_EQ(c.tally.with_inner_point, 0);
  EXPECT_EQ(c.points.size(), 8u);
  EXPECT_TRUE(
      std::any_of(c.cells.begin(), c.cells.end(), [&](const auto& cell) { return c.volume_of(cell) <= 0; }));
}

TEST(ElementCutting, TrianglesOfQuadrilaterals) {
  const auto triangles = [](auto corners) {
    std::vector<Triangle> out;
    for_each_triangle(corners, [&](const Triangle& triangle) { out.push_back(triangle); });
    return out;
  };
  using Quad = std::array<GlobalIndex, 4>;
  EXPECT_EQ(triangles(Quad{7, 3, 9, 5}), (std::vector<Triangle>{{3, 9, 5}, {3, 5, 7}}));
  EXPECT_EQ(triangles(Quad{7, 3, 3, 5}), (std::vector<Triangle>{{3, 5, 7}}));
  EXPECT_EQ(triangles(Quad{5, 7, 3, 5}), (std::vector<Triangle>{{3, 5, 7}}));
  for (const Quad& nothing :
       {Quad{7, 3, 7, 3}, Quad{7, 7, 3, 3}, Quad{1, 1, 1, 1}, Quad{1, 2, 1, 3}, Quad{2, 1, 3, 1}})
    EXPECT_TRUE(triangles(nothing).empty());
}

}  // namespace
}  // namespace alphadot
