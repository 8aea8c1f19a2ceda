// The state of a perfect gas and the physical flux through a moving face.
//
// Non-dimensional: density by rho_inf, speed by the sound speed a_inf, pressure by rho_inf a_inf^2; hence
// free-stream pressure 1/gamma and speed Mach.
#pragma once

#include <cmath>

#include "core/five.hpp"
#include "core/vec3.hpp"

namespace alphadot {

/// (rho, u, v, w, p): absolute velocity along the mesh axes.
template <class T>
using Primitive = Five<T>;
/// (rho, rho u, rho v, rho w, rho E); fluxes have the same order.
template <class T>
using Conserved = Five<T>;

/// Absolute velocity of the gas, in units of a_inf.
template <class T>
constexpr Vec3Of<T> velocity(const Primitive<T>& w) {
  return {w[1], w[2], w[3]};
}

/// rho E = p / (gamma - 1) + rho u . u / 2.
template <class T>
constexpr T total_energy(const Primitive<T>& w, Real gamma) {
  const auto u = velocity(w);
  return w[4] / (gamma - 1) + 0.5 * w[0] * dot(u, u);
}

/// Conserved from primitive variables.
template <class T>
constexpr Conserved<T> conserved(const Primitive<T>& w, Real gamma) {
  return {{w[0], w[0] * w[1], w[0] * w[2], w[0] * w[3], total_energy(w, gamma)}};
}

/// Primitive from conserved variables; the density must not be zero.
template <class T>
constexpr Primitive<T> primitive(const Conserved<T>& u, Real gamma) {
  const T inverse = 1.0 / u[0];
  const Vec3Of<T> q{u[1] * inverse, u[2] * inverse, u[3] * inverse};
  return {{u[0], q.x, q.y, q.z, (gamma - 1) * (u[4] - 0.5 * u[0] * dot(q, q))}};
}

/// a = sqrt(gamma p / rho), in units of a_inf; NaN at negative pressure.
template <class T>
T sound_speed(const Primitive<T>& w, Real gamma) {
  using std::sqrt;
  return sqrt(gamma * w[4] / w[0]);
}

inline Real mach_number(const Primitive<Real>& w, Real gamma) {
  return norm(velocity(w)) / sound_speed(w, gamma);
}

/// Free stream of the given Mach number; alpha turns it towards +z, beta (wind from starboard) towards -y.
/// Radians.
template <class T>
Primitive<T> free_stream(const Vec3Of<T>& velocity, Real gamma) {
  return {{T(1), velocity.x, velocity.y, velocity.z, T(1 / gamma)}};
}

/// Physical flux per unit area through a face with unit normal that moves with normal speed `grid_speed`:
/// U (u.n - vg) + p (0, n, u.n).
template <class T>
Conserved<T> physical_flux(const Primitive<T>& w, const Vec3& normal, const T& grid_speed, Real gamma) {
  const T un = dot(velocity(w), normal);
  const T mass = w[0] * (un - grid_speed);
  return {{mass, mass * w[1] + w[4] * normal.x, mass * w[2] + w[4] * normal.y, mass * w[3] + w[4] * normal.z,
           total_energy(w, gamma) * (un - grid_speed) + w[4] * un}};
}

}  // namespace alphadot
