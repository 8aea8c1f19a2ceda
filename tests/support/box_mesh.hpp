// A tetrahedral mesh of a box, for tests.
#pragma once

#include <array>
#include <cstdint>
#include <random>
#include <string>
#include <utility>

#include "partition/mesh.hpp"

namespace alphadot::testing_support {

/// What to mesh: `cells[d]` cubes along axis d between `lower` and `upper`, each cut into six tetrahedra.
struct BoxSettings {
  std::array<int, 3> cells{4, 4, 4};
  Vec3 lower{0, 0, 0};
  Vec3 upper{1, 1, 1};
  /// Interior points are moved by up to this share of the spacing along each axis. Volumes stay positive up
  /// to 0.16: the width of a Kuhn tetrahedron of the unit cube, 1/sqrt(3), exceeds twice the longest shift,
  /// sqrt(3) * perturbation.
  Real perturbation = 0;
  std::uint32_t seed = 1;
};

/// Six tetrahedra a cube (Kuhn's division: all share the diagonal, so that neighbouring cubes match). Patches
/// are named x_min, x_max, y_min, y_max, z_min, z_max, in that order, and stay plane. Point (i, j, k) has the
/// id i + (cells[0]+1) * (j + (cells[1]+1) * k); cube (i, j, k) has the six cells from 6 * (i + cells[0] * (j
/// + cells[1] * k)).
inline Mesh box_mesh(const BoxSettings& box = {}) {
  const auto [n, m, l] = box.cells;
  const auto point_id = [&](const std::array<int, 3>& at) {
    return at[0] + GlobalIndex{n + 1} * (at[1] + GlobalIndex{m + 1} * at[2]);
  };
  Mesh mesh;
  mesh.file = "box";

  std::mt19937 generator(box.seed);
  const auto shift = [&] { return box.perturbation * (2 * (generator() / 4294967295.0) - 1); };
  for (int k = 0; k <= l; ++k)
    for (int j = 0; j <= m; ++j)
      for (int i = 0; i <= n; ++i) {
        const std::array<int, 3> at{i, j, k};
        const bool interior = i > 0 && i < n && j > 0 && j < m && k > 0 && k < l;
        Vec3 point;
        for (int d = 0; d < 3; ++d) {
          const Real share = (at[d] + (interior ? shift() : 0)) / box.cells[d];
          point[d] = box.lower[d] * (1 - share) + box.upper[d] * share;
        }
        mesh.points.push_back(point);
      }

  constexpr std::array<std::array<int, 3>, 6> paths{
      {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}}};  // three even, then three odd
  for (int k = 0; k < l; ++k)
    for (int j = 0; j < m; ++j)
      for (int i = 0; i < n; ++i)
        for (int path = 0; path < 6; ++path) {
          std::array<int, 3> at{i, j, k};
          std::array<GlobalIndex, 4> cell{point_id(at)};
          for (int step = 0; step < 3; ++step) {
            ++at[paths[path][step]];
            cell[step + 1] = point_id(at);
          }
          if (path >= 3) std::swap(cell[1], cell[2]);
          mesh.cells.push_back(cell);
        }

  for (int d = 0; d < 3; ++d)
    for (const bool upper : {false, true}) {
      Patch patch{std::string(1, static_cast<char>('x' + d)) + (upper ? "_max" : "_min"), {}};
      const int a = (d + 1) % 3, b = (d + 2) % 3;
      for (int v = 0; v < box.cells[b]; ++v)
        for (int u = 0; u < box.cells[a]; ++u) {
          const auto corner = [&](int du, int dv) {
            std::array<int, 3> at{};
            at[d] = upper ? box.cells[d] : 0;
            at[a] = u + du;
            at[b] = v + dv;
            return point_id(at);
          };
          patch.triangles.push_back({corner(0, 0), corner(1, 0), corner(1, 1)});
          patch.triangles.push_back({corner(0, 0), corner(1, 1), corner(0, 1)});
        }
      mesh.patches.push_back(std::move(patch));
    }
  return mesh;
}

}  // namespace alphadot::testing_support
