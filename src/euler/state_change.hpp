// Small changes of the primitive state and of the conserved one, at a state w: dU/dW, its inverse and its
// transpose.
#pragma once

#include "euler/state.hpp"

namespace alphadot {

/// (dW/dU) du.
inline Primitive<Real> primitive_change(const Primitive<Real>& w, const Conserved<Real>& du, Real gamma) {
  const Vec3 u = velocity(w);
  const Real inverse = 1 / w[0];
  const Real work = w[1] * du[1] + w[2] * du[2] + w[3] * du[3];
  return {{du[0], inverse * (du[1] - u.x * du[0]), inverse * (du[2] - u.y * du[0]),
           inverse * (du[3] - u.z * du[0]), (gamma - 1) * (du[4] - work + 0.5 * dot(u, u) * du[0])}};
}

/// (dU/dW) dw.
inline Conserved<Real> conserved_change(const Primitive<Real>& w, const Primitive<Real>& dw, Real gamma) {
  const Vec3 u = velocity(w), du = velocity(dw);
  const Vec3 momentum = dw[0] * u + w[0] * du;
  return {{dw[0], momentum.x, momentum.y, momentum.z,
           dw[4] / (gamma - 1) + 0.5 * dw[0] * dot(u, u) + w[0] * dot(u, du)}};
}

/// (dU/dW)^T y: what a weight of the conserved state's change is for the primitive one's.
inline Primitive<Real> conserved_change_transposed(const Primitive<Real>& w, const Conserved<Real>& y,
                                                   Real gamma) {
  const Vec3 u = velocity(w), momentum = velocity(y);
  const Vec3 by_velocity = w[0] * (momentum + y[4] * u);
  return {{y[0] + dot(u, momentum) + 0.5 * dot(u, u) * y[4], by_velocity.x, by_velocity.y, by_velocity.z,
           y[4] / (gamma - 1)}};
}

}  // namespace alphadot
