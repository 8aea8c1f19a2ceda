// The transpose of pressure forces on walls.
#pragma once

#include "space/forces.hpp"

namespace alphadot {

/// What a unit of pressure on `area`, `arm` from the centre of moments, adds to weight . load.
inline Real pressure_weight(const Load& weight, const Vec3& area, const Vec3& arm) {
  return dot(weight.force, area) + dot(weight.moment, cross(arm, area));
}

/// What a unit of pressure on the wall of a boundary face, its area vector and place being these, adds to the
/// sum over patches of weight . load, `weights` being those of every patch: the transpose of wall_loads().
inline Real pressure_weight(const Discretization& discretization, std::size_t face, const Vec3& area,
                            const Vec3& at, std::span<const Load> weights, const Vec3& center) {
  const auto& wall = discretization.domain().boundary_faces[face];
  if (discretization.kind_of(wall) != BoundaryKind::wall) return 0;
  return pressure_weight(weights[static_cast<std::size_t>(wall.patch)], area, at - center);
}

}  // namespace alphadot
