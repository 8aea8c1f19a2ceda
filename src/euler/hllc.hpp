// The HLLC approximate Riemann solver on a moving face.
#pragma once

#include "euler/state.hpp"

namespace alphadot {

/// Flux per unit area (Toro, Spruce & Speares 1994; wave speeds of Einfeldt from the Roe mean, Batten et al.
/// 1997). The sides of the contact are told apart by its speed relative to the face. About 150 flops.
template <class T>
Conserved<T> hllc_flux(const Primitive<T>& left, const Primitive<T>& right, const Vec3& normal,
                       const T& grid_speed, Real gamma) {
  using std::sqrt;
  const auto ul = velocity(left), ur = velocity(right);
  const T vl = dot(ul, normal), vr = dot(ur, normal);
  const T al = sound_speed(left, gamma), ar = sound_speed(right, gamma);

  const T ratio = sqrt(right[0] / left[0]);
  const T weight = 1.0 / (1.0 + ratio);
  const Vec3Of<T> u = weight * (ul + ratio * ur);
  const T enthalpy_l = (total_energy(left, gamma) + left[4]) / left[0];
  const T enthalpy_r = (total_energy(right, gamma) + right[4]) / right[0];
  const T enthalpy = weight * (enthalpy_l + ratio * enthalpy_r);
  const T a = sqrt((gamma - 1) * (enthalpy - 0.5 * dot(u, u)));
  const T un = dot(u, normal);

  const T speed_l = vl - al < un - a ? T(vl - al) : T(un - a);
  const T speed_r = vr + ar > un + a ? T(vr + ar) : T(un + a);
  if (speed_l >= grid_speed) return physical_flux(left, normal, grid_speed, gamma);
  if (speed_r <= grid_speed) return physical_flux(right, normal, grid_speed, gamma);

  const T inflow_l = left[0] * (speed_l - vl), inflow_r = right[0] * (speed_r - vr);
  const T contact = (right[4] - left[4] + inflow_l * vl - inflow_r * vr) / (inflow_l - inflow_r);
  const bool left_side = contact >= grid_speed;
  const Primitive<T>& side = left_side ? left : right;
  const T& speed = left_side ? speed_l : speed_r;
  const T& v = left_side ? vl : vr;
  const T& inflow = left_side ? inflow_l : inflow_r;

  // The state between the outer wave and the contact, and its flux: F* = U* (contact - vg) + p* (0, n,
  // contact).
  const T p = side[4] + inflow * (contact - v);
  const T rho = inflow / (speed - contact);
  const T mass = rho * (contact - grid_speed);
  const T energy = (total_energy(side, gamma) * (speed - v) - side[4] * v + p * contact) / (speed - contact);
  Conserved<T> flux;
  flux[0] = mass;
  for (int i = 0; i < 3; ++i) flux[i + 1] = mass * (side[i + 1] + (contact - v) * normal[i]) + p * normal[i];
  flux[4] = energy * (contact - grid_speed) + p * contact;
  return flux;
}

}  // namespace alphadot
