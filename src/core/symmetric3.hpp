// Symmetric 3 x 3 matrices: second moments of points and the inverses of their sums.
#pragma once

#include "core/vec3.hpp"

namespace alphadot {

/// Symmetric 3 x 3 matrix (xx, xy, xz, yy, yz, zz).
struct Symmetric3 {
  Real xx, xy, xz, yy, yz, zz;
};

/// Matrix times vector.
inline Vec3 operator*(const Symmetric3& a, const Vec3& b) {
  return {a.xx * b.x + a.xy * b.y + a.xz * b.z, a.xy * b.x + a.yy * b.y + a.yz * b.z,
          a.xz * b.x + a.yz * b.y + a.zz * b.z};
}

/// Adds d d^T.
inline void add_square(Symmetric3& sum, const Vec3& d) {
  sum.xx += d.x * d.x;
  sum.xy += d.x * d.y;
  sum.xz += d.x * d.z;
  sum.yy += d.y * d.y;
  sum.yz += d.y * d.z;
  sum.zz += d.z * d.z;
}

/// Not finite when there is none.
inline Symmetric3 inverse(const Symmetric3& a) {
  const Real cxx = a.yy * a.zz - a.yz * a.yz, cxy = a.xz * a.yz - a.xy * a.zz,
             cxz = a.xy * a.yz - a.xz * a.yy;
  const Real scale = 1 / (a.xx * cxx + a.xy * cxy + a.xz * cxz);
  return {scale * cxx,
          scale * cxy,
          scale * cxz,
          scale * (a.xx * a.zz - a.xz * a.xz),
          scale * (a.xy * a.xz - a.xx * a.yz),
          scale * (a.xx * a.yy - a.xy * a.xy)};
}

}  // namespace alphadot
