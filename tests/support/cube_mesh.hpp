// A cube in a box.
#pragma once

#include <algorithm>
#include <array>
#include <vector>

#include "partition/face_matching.hpp"
#include "support/box_mesh.hpp"

namespace alphadot::testing_support {

/// The box `outside` without the cubes between `lower` and `upper`, whose surface is the patch "body".
inline Mesh around_a_cube(const BoxSettings& outside, const Vec3& lower, const Vec3& upper) {
  Mesh mesh = box_mesh(outside);
  const auto is_inside = [&](const auto& ids) {
    Vec3 center;
    for (const GlobalIndex id : ids) center += 1.0 / static_cast<Real>(ids.size()) * mesh.points[id];
    bool out = true;
    for (int d = 0; d < 3; ++d) out &= lower[d] - 1e-9 < center[d] && center[d] < upper[d] + 1e-9;
    return out;
  };
  std::erase_if(mesh.cells, is_inside);
  for (auto& patch : mesh.patches) std::erase_if(patch.triangles, is_inside);
  std::vector<std::array<GlobalIndex, 3>> triangles;
  for (const auto& patch : mesh.patches)
    triangles.insert(triangles.end(), patch.triangles.begin(), patch.triangles.end());
  Patch body{"body", {}};
  for_each_face<GlobalIndex>(mesh.cells, triangles, mesh.points.size(), [&](std::span<const Index> sides) {
    if (sides.size() == 1) body.triangles.push_back(side_points<GlobalIndex>(mesh.cells, sides[0]));
  });
  mesh.patches.push_back(body);
  return mesh;
}

}  // namespace alphadot::testing_support
