// Fluxes through the boundary of the domain.
#pragma once

#include "euler/state.hpp"

namespace alphadot {

/// Pressure on a slip wall or symmetry plane that moves with the normal speed `grid_speed`, from the gas at
/// it: the exact solution of their Riemann problem, a shock where the gas runs into the wall and a simple
/// wave where it recedes. Linear: p + rho a (u.n - vg). `normal` points out of the gas.
template <class T>
T wall_pressure(const Primitive<T>& inside, const Vec3& normal, const T& grid_speed, Real gamma) {
  using std::pow;
  using std::sqrt;
  const T mach = (dot(velocity(inside), normal) - grid_speed) / sound_speed(inside, gamma);
  if (mach > T(0)) {
    const T quarter = 0.25 * (gamma + 1) * mach;
    return inside[4] * (1.0 + gamma * mach * (quarter + sqrt(1.0 + quarter * quarter)));
  }
  const T base = 1.0 + 0.5 * (gamma - 1) * mach;  // ratio of the speeds of sound
  return base > T(0) ? T(inside[4] * pow(base, 2 * gamma / (gamma - 1))) : T(0);
}

/// Slip wall or symmetry plane: only pressure acts, and does work at the speed of the face.
template <class T>
Conserved<T> wall_flux(const T& pressure, const Vec3& normal, const T& grid_speed) {
  return {{T(0), pressure * normal.x, pressure * normal.y, pressure * normal.z, pressure * grid_speed}};
}

/// State on a far-field face from the Riemann invariants that enter and leave, all relative to the moving
/// face. Supersonic normal flow takes the whole state from upstream. `normal` points out of the domain.
template <class T>
Primitive<T> characteristic_state(const Primitive<T>& inside, const Primitive<T>& outside, const Vec3& normal,
                                  const T& grid_speed, Real gamma) {
  using std::pow;
  const T ai = sound_speed(inside, gamma), ao = sound_speed(outside, gamma);
  const T vi = dot(velocity(inside), normal) - grid_speed, vo = dot(velocity(outside), normal) - grid_speed;
  if (vo <= -1.0 * ao) return outside;
  if (vi >= ai) return inside;
  const T leaving = vi + 2.0 / (gamma - 1) * ai, entering = vo - 2.0 / (gamma - 1) * ao;
  const T v = 0.5 * (leaving + entering);
  const T a = 0.25 * (gamma - 1) * (leaving - entering);
  const bool outflow = v > T(0);
  const Primitive<T>& side = outflow ? inside : outside;
  const T dv = v - (outflow ? vi : vo);
  const T squared = a * a * side[0] / (gamma * side[4]);  // (a / a_side)^2, entropy carried by the side
  Primitive<T> face;
  face[0] = side[0] * pow(squared, 1 / (gamma - 1));
  for (int i = 0; i < 3; ++i) face[i + 1] = side[i + 1] + dv * normal[i];
  face[4] = face[0] * a * a / gamma;
  return face;
}

/// Far field: physical flux of the characteristic state.
template <class T>
Conserved<T> far_field_flux(const Primitive<T>& inside, const Primitive<T>& outside, const Vec3& normal,
                            const T& grid_speed, Real gamma) {
  return physical_flux(characteristic_state(inside, outside, normal, grid_speed, gamma), normal, grid_speed,
                       gamma);
}

}  // namespace alphadot
