// Van Leer's flux vector splitting on a moving face.
#pragma once

#include "euler/state.hpp"

namespace alphadot {

/// The part of the flux that waves running along `direction` * normal carry (direction = +1 or -1), for a
/// face at rest in its own frame. Van Leer 1982, equations (11)-(15).
template <class T>
Conserved<T> van_leer_split(const Primitive<T>& w, const Vec3& normal, Real direction, Real gamma) {
  const T a = sound_speed(w, gamma);
  const auto u = velocity(w);
  const T un = dot(u, normal);
  if (direction * un >= a) return physical_flux(w, normal, T(0), gamma);
  if (direction * un <= -1.0 * a) return {};
  const T shifted = un + direction * a;
  const T mass = direction * 0.25 * w[0] * shifted * shifted / a;
  const T push = (2.0 * direction * a - un) / gamma;
  const T speed = (gamma - 1) * un + 2.0 * direction * a;
  const T energy = speed * speed / (2 * (gamma * gamma - 1)) + 0.5 * (dot(u, u) - un * un);
  return {{mass, mass * (u.x + push * normal.x), mass * (u.y + push * normal.y),
           mass * (u.z + push * normal.z), mass * energy}};
}

/// Flux per unit area. The splitting is done in the frame of the face, then carried back to the inertial
/// frame: the momentum gains grid_speed n times the mass flux, the energy grid_speed times the normal
/// momentum flux and grid_speed^2 / 2 times the mass flux. About 120 flops.
template <class T>
Conserved<T> van_leer_flux(Primitive<T> left, Primitive<T> right, const Vec3& normal, const T& grid_speed,
                           Real gamma) {
  for (int i = 0; i < 3; ++i) {
    left[i + 1] -= grid_speed * normal[i];
    right[i + 1] -= grid_speed * normal[i];
  }
  Conserved<T> flux = van_leer_split(left, normal, 1.0, gamma) + van_leer_split(right, normal, -1.0, gamma);
  const T normal_momentum = flux[1] * normal.x + flux[2] * normal.y + flux[3] * normal.z;
  for (int i = 0; i < 3; ++i) flux[i + 1] += grid_speed * normal[i] * flux[0];
  flux[4] += grid_speed * (normal_momentum + 0.5 * grid_speed * flux[0]);
  return flux;
}

}  // namespace alphadot
