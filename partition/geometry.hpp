// Metrics of triangles and tetrahedra that do not depend on the order in which a rank stores their points.
#pragma once

#include <array>

#include "core/types.hpp"
#include "core/vec3.hpp"

namespace alphadot {

/// The corners of the face of a tetrahedron opposite each of its corners, right-handed about the outward
/// normal when the volume is positive.
inline constexpr std::array<std::array<int, 3>, 4> tetrahedron_faces{
    {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}}};

struct TriangleMetrics {
  Vec3 normal;  ///< area vector, right-handed about the corners in the order given
  Vec3 center;  ///< centroid
};

struct TetrahedronMetrics {
  Real volume;  ///< positive when (p1-p0) x (p2-p0) . (p3-p0) > 0 in the order given
  Vec3 center;  ///< centroid
};

/// How far a tetrahedron is from a regular one.
struct TetrahedronShape {
  Real smallest_angle;  ///< between two of its faces, degrees; 70.5 when regular
  Real aspect_ratio;    ///< longest edge over smallest height; scaled to 1 when regular
};

/// Metrics of a triangle or tetrahedron from its corners and their global ids. Computed in the order of the
/// ids, so that every rank, at every number of ranks, finds bitwise the same value (the sign of normal and
/// volume aside, which follows the order given).
TriangleMetrics triangle_metrics(std::array<Vec3, 3> points, std::array<GlobalIndex, 3> ids);
TetrahedronMetrics tetrahedron_metrics(std::array<Vec3, 4> points, std::array<GlobalIndex, 4> ids);
TetrahedronShape tetrahedron_shape(std::array<Vec3, 4> points, std::array<GlobalIndex, 4> ids);

}  // namespace alphadot
