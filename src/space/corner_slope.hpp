// Linear interpolation over a tetrahedron.
#pragma once

#include "partition/subdomain.hpp"

namespace alphadot {

/// Gradient of the linear function that is one at a corner of a cell and zero at the others. Over a
/// tetrahedron the surface integral of values linear on its faces is that of the linear interpolant, whose
/// gradient is the sum over corners of value times the inward area of the opposite face over 3 V.
inline Vec3 corner_slope(const Subdomain& domain, Index cell, std::size_t corner) {
  const auto& corners = domain.cell_points[cell];
  const Vec3& a = domain.points[corners[(corner + 1) % 4]];
  const Vec3& b = domain.points[corners[(corner + 2) % 4]];
  const Vec3& c = domain.points[corners[(corner + 3) % 4]];
  const Vec3 area = cross(b - a, c - a);
  return (1 / dot(domain.points[corners[corner]] - a, area)) * area;
}

}  // namespace alphadot
