// How fast signals cross a moving face.
#pragma once

#include <cmath>

#include "euler/state.hpp"

namespace alphadot {

/// Spectral radius |u.n - vg| + a of the flux Jacobian.
inline Real spectral_radius(const Primitive<Real>& w, const Vec3& normal, Real grid_speed, Real gamma) {
  return std::abs(dot(velocity(w), normal) - grid_speed) + sound_speed(w, gamma);
}

/// Change of the primitive state that a small change of the conserved one makes at `w`.
inline Primitive<Real> primitive_change(const Primitive<Real>& w, const Conserved<Real>& du, Real gamma) {
  const Vec3 u = velocity(w);
  const Real inverse = 1 / w[0];
  const Real work = w[1] * du[1] + w[2] * du[2] + w[3] * du[3];
  return {{du[0], inverse * (du[1] - u.x * du[0]), inverse * (du[2] - u.y * du[0]),
           inverse * (du[3] - u.z * du[0]), (gamma - 1) * (du[4] - work + 0.5 * dot(u, u) * du[0])}};
}

}  // namespace alphadot
