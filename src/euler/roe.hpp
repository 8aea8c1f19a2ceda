// Roe's approximate Riemann solver on a moving face, with Harten's entropy fix.
#pragma once

#include "euler/state.hpp"

namespace alphadot {

/// |lambda|, rounded off below `delta` (Harten 1983) so that no wave is left without dissipation.
template <class T>
T harten(const T& lambda, const T& delta) {
  using std::abs;
  const T magnitude = abs(lambda);
  return magnitude < delta ? T(0.5 * (lambda * lambda / delta + delta)) : magnitude;
}

/// Flux per unit area (Roe 1981): mean of the physical fluxes minus half the jump resolved in waves, whose
/// speeds are relative to the face. `entropy_fix`: Harten's delta as a share of |u.n - vg| + a. About 190
/// flops, 2 sqrt, 6 divisions.
template <class T>
Conserved<T> roe_flux(const Primitive<T>& left, const Primitive<T>& right, const Vec3& normal,
                      const T& grid_speed, Real gamma, Real entropy_fix) {
  using std::abs;
  using std::sqrt;
  const auto ul = velocity(left), ur = velocity(right);
  const T vl = dot(ul, normal), vr = dot(ur, normal);
  const T energy_l = total_energy(left, gamma), energy_r = total_energy(right, gamma);
  const T enthalpy_l = (energy_l + left[4]) / left[0], enthalpy_r = (energy_r + right[4]) / right[0];

  const T ratio = sqrt(right[0] / left[0]);
  const T weight = 1.0 / (1.0 + ratio);
  const Vec3Of<T> u = weight * (ul + ratio * ur);
  const T enthalpy = weight * (enthalpy_l + ratio * enthalpy_r);
  const T rho = ratio * left[0];
  const T q2 = dot(u, u);
  const T a2 = (gamma - 1) * (enthalpy - 0.5 * q2);
  const T a = sqrt(a2);
  const T un = dot(u, normal);

  const T relative = un - grid_speed;
  const T delta = entropy_fix * (abs(relative) + a);
  const T lambda_minus = harten(T(relative - a), delta);
  const T lambda_zero = harten(relative, delta);
  const T lambda_plus = harten(T(relative + a), delta);

  const T drho = right[0] - left[0], dp = right[4] - left[4], dun = vr - vl;
  const Vec3Of<T> du = ur - ul;
  const T half_inverse_a2 = 0.5 / a2;
  const T minus = lambda_minus * (dp - rho * a * dun) * half_inverse_a2;
  const T plus = lambda_plus * (dp + rho * a * dun) * half_inverse_a2;
  const T entropy = lambda_zero * (drho - 2.0 * dp * half_inverse_a2);
  const T shear = lambda_zero * rho;

  const T mass_l = left[0] * (vl - grid_speed), mass_r = right[0] * (vr - grid_speed);
  const T sum = minus + plus + entropy, difference = a * (plus - minus);
  const T pressure = left[4] + right[4];
  Conserved<T> flux;
  flux[0] = 0.5 * (mass_l + mass_r - sum);
  for (int i = 0; i < 3; ++i)
    flux[i + 1] = 0.5 * (mass_l * ul[i] + mass_r * ur[i] + pressure * normal[i] - sum * u[i] -
                         difference * normal[i] - shear * (du[i] - dun * normal[i]));
  flux[4] = 0.5 * (energy_l * (vl - grid_speed) + left[4] * vl + energy_r * (vr - grid_speed) +
                   right[4] * vr - (minus + plus) * enthalpy - difference * un - entropy * 0.5 * q2 -
                   shear * (dot(u, du) - un * dun));
  return flux;
}

}  // namespace alphadot
