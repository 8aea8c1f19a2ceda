// The transpose of pressure forces on walls.
#pragma once

#include "space/forces.hpp"

namespace alphadot {

/// What a unit of pressure on a boundary face adds to the sum over patches of weight . load, `weights` being
/// those of every patch: the transpose of wall_loads().
inline Real pressure_weight(const Discretization& discretization, std::size_t face,
                            std::span<const Load> weights, const Vec3& center) {
  const Subdomain& domain = discretization.domain();
  const auto& at = domain.boundary_faces[face];
  if (discretization.kind_of(at) != BoundaryKind::wall) return 0;
  const Load& weight = weights[static_cast<std::size_t>(at.patch)];
  const Vec3& area = domain.boundary_normal[face];
  return dot(weight.force, area) + dot(weight.moment, cross(domain.boundary_center[face] - center, area));
}

}  // namespace alphadot
