// Attitudes of any size without a singular one.
#pragma once

#include <cmath>

#include "core/vec3.hpp"

namespace alphadot {

/// A unit quaternion: the rotation that carries the axes at rest onto those of the body.
struct Quaternion {
  Real w = 1;
  Vec3 v;

  bool operator==(const Quaternion&) const = default;
};

/// The rotation `b`, about axes already turned by `a`, after `a`.
inline Quaternion operator*(const Quaternion& a, const Quaternion& b) {
  return {a.w * b.w - dot(a.v, b.v), a.w * b.v + b.w * a.v + cross(a.v, b.v)};
}

inline Quaternion normalised(const Quaternion& q) {
  const Real scale = 1 / std::sqrt(q.w * q.w + dot(q.v, q.v));
  return {scale * q.w, scale * q.v};
}

/// Of a rotation by |angle| rad about `angle`.
inline Quaternion quaternion_of(const Vec3& angle) {
  const Real turn = norm(angle);
  const Real share = turn < 1e-4 ? 0.5 - turn * turn / 48 : std::sin(turn / 2) / turn;
  return {std::cos(turn / 2), share * angle};
}

/// The rotation vector, of at most half a turn.
inline Vec3 rotation_vector(const Quaternion& q) {
  const Real sine = norm(q.v), sign = q.w < 0 ? -1 : 1;
  const Real share = sine < 1e-8 ? 2 : 2 * std::atan2(sine, std::abs(q.w)) / sine;
  return sign * share * q.v;
}

}  // namespace alphadot
