// A face as fluxes see it.
#pragma once

#include "partition/subdomain.hpp"

namespace alphadot {

/// Of a face between cells from left to right, of a boundary face outward; in the subdomain's unit.
struct FaceGeometry {
  Real area;
  Vec3 normal;  ///< of unit length
  Vec3 center;
};

/// From its area vector, which must not be zero.
inline FaceGeometry face_geometry(const Vec3& area_vector, const Vec3& center) {
  const Real area = norm(area_vector);
  return {area, (1 / area) * area_vector, center};
}

/// Of an interior face by its number in Subdomain::faces.
inline FaceGeometry interior_geometry(const Subdomain& domain, std::size_t face) {
  return face_geometry(domain.face_normal[face], domain.face_center[face]);
}

/// Of a boundary face by its number in Subdomain::boundary_faces.
inline FaceGeometry boundary_geometry(const Subdomain& domain, std::size_t face) {
  return face_geometry(domain.boundary_normal[face], domain.boundary_center[face]);
}

}  // namespace alphadot
