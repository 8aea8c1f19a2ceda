// Meshes of a box out of tetrahedra, pyramids, prisms and hexahedra, as a file may hold them.
#pragma once

#include <algorithm>
#include <array>
#include <numeric>
#include <random>
#include <string>
#include <vector>

#include "io/element_cutting.hpp"

namespace alphadot::testing_support {

/// What the cubes of a column of the box are: whole, cut into two prisms along z, or cut about their middle,
/// into a pyramid or two tetrahedra at each side.
enum class Column { hexahedra, prisms, middles };

struct MixedMeshSettings {
  std::array<int, 3> cubes{2, 3, 2};
  std::vector<Column> columns{Column::hexahedra};  ///< that may occur; drawn at random
  int triangle_percent =
      50;  ///< sides between middles, and between them and the boundary, that are triangles
  std::uint32_t seed = 1;
};

struct MixedElement {
  Shape shape;
  std::vector<GlobalIndex> corners;
};

/// Points are numbered at random, one element in five is left-handed, and inner points are moved, so that
/// sides are not plane.
struct MixedMesh {
  std::vector<Vec3> points;
  std::vector<MixedElement> volumes;
  std::array<std::vector<MixedElement>, 6> sides;  ///< x = 0, x = 2, y = 0, y = 3, z = 0, z = 1

  static constexpr Real volume = 6;
  static constexpr std::array<Real, 6> areas{3, 3, 2, 2, 6, 6};

  GlobalIndex count(Shape shape) const {
    return std::count_if(volumes.begin(), volumes.end(), [&](const auto& e) { return e.shape == shape; });
  }
  /// Tetrahedra that they make: 6 a hexahedron, 3 a prism, 2 a pyramid.
  GlobalIndex tetrahedra() const {
    return 6 * count(Shape::hexahedron) + 3 * count(Shape::prism) + 2 * count(Shape::pyramid) +
           count(Shape::tetrahedron);
  }
  GlobalIndex triangles(std::size_t side) const {
    GlobalIndex out = 0;
    for (const auto& element : sides[side]) out += element.shape == Shape::triangle ? 1 : 2;
    return out;
  }
};

class MixedMeshMaker {
 public:
  explicit MixedMeshMaker(MixedMeshSettings settings) : s_(std::move(settings)), random_(s_.seed) {}

  MixedMesh make() {
    add_points();
    const auto [n, m, l] = s_.cubes;
    for (int i = 0; i < n * m; ++i) columns_.push_back(s_.columns[random_() % s_.columns.size()]);
    for (int k = 0; k < l; ++k)
      for (int j = 0; j < m; ++j)
        for (int i = 0; i < n; ++i) add_cube({i, j, k});
    shuffle();
    return std::move(mesh_);
  }

 private:
  using Place = std::array<int, 3>;
  using Quad = std::array<GlobalIndex, 4>;

  GlobalIndex point(const Place& at) const {
    return at[0] + GlobalIndex{s_.cubes[0] + 1} * (at[1] + GlobalIndex{s_.cubes[1] + 1} * at[2]);
  }

  void add_points() {
    constexpr std::array<Real, 3> lengths{2, 3, 1};
    Place at{};
    for (at[2] = 0; at[2] <= s_.cubes[2]; ++at[2])
      for (at[1] = 0; at[1] <= s_.cubes[1]; ++at[1])
        for (at[0] = 0; at[0] <= s_.cubes[0]; ++at[0]) {
          Vec3 place;
          for (int d = 0; d < 3; ++d) {
            const auto i = static_cast<std::size_t>(d);
            const bool inner = at[i] > 0 && at[i] < s_.cubes[i];
            const Real shift = inner ? 0.2 * (static_cast<Real>(random_() % 1001) / 1000 - 0.5) : 0;
            place[d] = lengths[i] * (at[i] + shift) / s_.cubes[i];
          }
          mesh_.points.push_back(place);
        }
  }

  Column column(int i, int j) const { return columns_[static_cast<std::size_t>(i + s_.cubes[0] * j)]; }

  /// The side of a cube across `axis`, as its two owners see it alike: the corners go round, and `cut` tells
  /// whether it is two triangles, along the diagonal from the first corner or, with `turned`, from the
  /// second.
  struct Side {
    Quad corners;
    bool cut = false, turned = false;
  };
  Side side(Place cube, int axis, bool upper) const {
    const auto d = static_cast<std::size_t>(axis), a = (d + 1) % 3, b = (d + 2) % 3;
    Place base = cube;
    base[d] += upper;
    Side out;
    for (std::size_t i = 0; i < 4; ++i) {
      Place at = base;
      at[a] += i == 1 || i == 2;
      at[b] += i >= 2;
      out.corners[i] = point(at);
    }
    bool all_middles = true, along_prisms = axis == 2;
    for (const int step : {-1, 0}) {
      Place at = base;
      at[d] += step;
      if (at[d] < 0 || at[d] >= s_.cubes[d]) continue;
      all_middles = all_middles && column(at[0], at[1]) == Column::middles;
      along_prisms = along_prisms && column(at[0], at[1]) == Column::prisms;
    }
    const auto dice =
        static_cast<unsigned>(base[0] * 7919 + base[1] * 104729 + base[2] * 1299709 + axis * 15485863) +
        s_.seed * 32452843u;
    out.cut = along_prisms || (all_middles && static_cast<int>(dice / 64 % 100) < s_.triangle_percent);
    out.turned = !along_prisms && dice / 8192 % 2 == 1;
    return out;
  }

  static std::vector<MixedElement> faces(const Side& side) {
    const auto& q = side.corners;
    if (!side.cut) return {{Shape::quadrilateral, {q[0], q[1], q[2], q[3]}}};
    if (side.turned) return {{Shape::triangle, {q[1], q[2], q[3]}}, {Shape::triangle, {q[1], q[3], q[0]}}};
    return {{Shape::triangle, {q[0], q[1], q[2]}}, {Shape::triangle, {q[0], q[2], q[3]}}};
  }

  void add_cube(const Place& cube) {
    const auto [i, j, k] = cube;
    const auto at = [&](int x, int y, int z) { return point({i + x, j + y, k + z}); };
    switch (column(i, j)) {
      case Column::hexahedra:
        mesh_.volumes.push_back({Shape::hexahedron,
                                 {at(0, 0, 0), at(1, 0, 0), at(1, 1, 0), at(0, 1, 0), at(0, 0, 1),
                                  at(1, 0, 1), at(1, 1, 1), at(0, 1, 1)}});
        break;
      case Column::prisms:
        mesh_.volumes.push_back(
            {Shape::prism, {at(0, 0, 0), at(1, 0, 0), at(1, 1, 0), at(0, 0, 1), at(1, 0, 1), at(1, 1, 1)}});
        mesh_.volumes.push_back(
            {Shape::prism, {at(0, 0, 0), at(1, 1, 0), at(0, 1, 0), at(0, 0, 1), at(1, 1, 1), at(0, 1, 1)}});
        break;
      case Column::middles:
        add_middle(cube);
    }
    for (int axis = 0; axis < 3; ++axis)
      for (const bool upper : {false, true}) {
        const auto d = static_cast<std::size_t>(axis);
        if (cube[d] != (upper ? s_.cubes[d] - 1 : 0)) continue;
        for (auto& face : faces(side(cube, axis, upper)))
          mesh_.sides[2 * d + upper].push_back(std::move(face));
      }
  }

  void add_middle(const Place& cube) {
    const auto [i, j, k] = cube;
    Vec3 center;
    for (int corner = 0; corner < 8; ++corner)
      center +=
          0.125 *
          mesh_.points[static_cast<std::size_t>(point({i + corner % 2, j + corner / 2 % 2, k + corner / 4}))];
    const auto middle = static_cast<GlobalIndex>(mesh_.points.size());
    mesh_.points.push_back(center);
    for (int axis = 0; axis < 3; ++axis)
      for (const bool upper : {false, true})
        for (auto face : faces(side(cube, axis, upper))) {
          // The corners of a side go round the axis: inward at its lower end.
          if (upper) std::reverse(face.corners.begin(), face.corners.end());
          face.corners.push_back(middle);
          mesh_.volumes.push_back(
              {face.shape == Shape::triangle ? Shape::tetrahedron : Shape::pyramid, std::move(face.corners)});
        }
  }

  /// Numbers points at random, turns some elements, and mixes their order.
  void shuffle() {
    std::vector<GlobalIndex> number(mesh_.points.size());
    std::iota(number.begin(), number.end(), GlobalIndex{0});
    for (std::size_t i = number.size(); i > 1; --i) std::swap(number[i - 1], number[random_() % i]);
    std::vector<Vec3> points(number.size());
    for (std::size_t i = 0; i < number.size(); ++i)
      points[static_cast<std::size_t>(number[i])] = mesh_.points[i];
    mesh_.points = std::move(points);
    const auto renumber = [&](MixedElement& element) {
      for (GlobalIndex& corner : element.corners) corner = number[static_cast<std::size_t>(corner)];
    };
    for (auto& element : mesh_.volumes) {
      renumber(element);
      if (random_() % 5 == 0) turn(element);
    }
    for (std::size_t i = mesh_.volumes.size(); i > 1; --i)
      std::swap(mesh_.volumes[i - 1], mesh_.volumes[random_() % i]);
    for (auto& side : mesh_.sides)
      for (auto& element : side) renumber(element);
  }

  static void turn(MixedElement& element) {
    auto& corners = element.corners;
    const auto half = static_cast<std::ptrdiff_t>(corners.size() / 2);
    if (element.shape == Shape::tetrahedron || element.shape == Shape::pyramid)
      std::swap(corners[1], corners[element.shape == Shape::pyramid ? 3 : 2]);
    else
      std::rotate(corners.begin(), corners.begin() + half, corners.end());
  }

  MixedMeshSettings s_;
  std::mt19937 random_;
  MixedMesh mesh_;
  std::vector<Column> columns_;
};

inline MixedMesh mixed_mesh(const MixedMeshSettings& settings) {
  return MixedMeshMaker(settings).make();
}

}  // namespace alphadot::testing_support
