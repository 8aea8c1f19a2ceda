// Mach 2 flow up a ramp of ten degrees: a box bent into shape.
#pragma once

#include <algorithm>
#include <cmath>

#include "support/box_case.hpp"

namespace alphadot::testing_support {

inline constexpr Real ramp_mach = 2, ramp_angle = 10 * radians_per_degree;

/// A slice one cube thick; n cubes to the unit of length. The ramp begins at x = 0 and rises as far as x = 1,
/// where the shock leaves below the ceiling z = 1.
inline Mesh ramp_mesh(int n) {
  const Real spacing = 1.0 / n;
  Mesh mesh = box_mesh({.cells = {n + n / 4, 1, n}, .lower = {-0.25, 0, 0}, .upper = {1, spacing, 1}});
  for (Vec3& point : mesh.points)
    point.z += (1 - point.z) * std::max(Real{0}, point.x) * std::tan(ramp_angle);
  return mesh;
}

inline BoxSides ramp_sides() {
  return {BoundaryKind::farfield, BoundaryKind::farfield, BoundaryKind::symmetry,
          BoundaryKind::symmetry, BoundaryKind::wall,     BoundaryKind::farfield};
}

inline Conditions<Real> ramp_conditions() {
  return {free_stream(Vec3{ramp_mach, 0, 0}, gamma_air), {}};
}

}  // namespace alphadot::testing_support
