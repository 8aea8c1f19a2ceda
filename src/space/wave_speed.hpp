// How fast signals cross a moving face.
#pragma once

#include <cmath>
#include <vector>

#include "euler/state.hpp"
#include "space/conditions.hpp"
#include "space/discretization.hpp"
#include "space/flow_field.hpp"

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

/// Change of the conserved state that a small change of the primitive one makes at `w`.
inline Conserved<Real> conserved_change(const Primitive<Real>& w, const Primitive<Real>& dw, Real gamma) {
  const Vec3 u = velocity(w), du = velocity(dw);
  const Vec3 momentum = dw[0] * u + w[0] * du;
  return {{dw[0], momentum.x, momentum.y, momentum.z,
           dw[4] / (gamma - 1) + 0.5 * dw[0] * dot(u, u) + w[0] * dot(u, du)}};
}

/// [owned_cells] sum over the faces of a cell of area times spectral radius: V / dtau at a CFL number of one.
std::vector<Real> wave_speeds(const Discretization& discretization, const FlowField<Real>& flow,
                              const Conditions<Real>& conditions);

}  // namespace alphadot
