// The six force and moment coefficients of a configuration, and the change of their moment centre.
#pragma once

#include <array>
#include <cstddef>
#include <string_view>
#include <utility>

#include "core/vec3.hpp"

namespace alphadot {

/// Names in the order of CoefficientsOf::operator[].
inline constexpr std::array<std::string_view, 6> coefficient_names = {"CA", "CY", "CN", "Cl", "Cm", "Cn"};

/// Forces over q_inf S and moments over q_inf S l, q_inf with the fixed free-stream speed.
/// Mesh axes are x aft, y starboard, z up. Forces: CA = Fx, CY = Fy, CN = Fz. Moments about the standard body
/// axes (x forward, y starboard, z down): Cl = -Mx, Cm = My (nose up), Cn = -Mz (nose to starboard).
template <class T>
struct CoefficientsOf {
  T CA{}, CY{}, CN{}, Cl{}, Cm{}, Cn{};

  static constexpr int size() { return 6; }
  constexpr const T& operator[](int i) const {
    constexpr std::array members = {&CoefficientsOf::CA, &CoefficientsOf::CY, &CoefficientsOf::CN,
                                    &CoefficientsOf::Cl, &CoefficientsOf::Cm, &CoefficientsOf::Cn};
    return this->*members[static_cast<std::size_t>(i)];
  }
  constexpr T& operator[](int i) { return const_cast<T&>(std::as_const(*this)[i]); }

  /// Force and moment in mesh axes.
  constexpr Vec3Of<T> force() const { return {CA, CY, CN}; }
  constexpr Vec3Of<T> moment() const { return {-Cl, Cm, -Cn}; }

  constexpr CoefficientsOf& operator+=(const CoefficientsOf& b) {
    for (int i = 0; i < size(); ++i) (*this)[i] += b[i];
    return *this;
  }
};

using Coefficients = CoefficientsOf<Real>;

template <class T>
constexpr CoefficientsOf<T> operator+(CoefficientsOf<T> a, const CoefficientsOf<T>& b) {
  return a += b;
}
template <class S, class T>
constexpr CoefficientsOf<T> operator*(const S& s, CoefficientsOf<T> a) {
  for (int i = 0; i < a.size(); ++i) a[i] = s * a[i];
  return a;
}
template <class T>
constexpr CoefficientsOf<T> operator-(const CoefficientsOf<T>& a, const CoefficientsOf<T>& b) {
  return a + Real(-1) * b;
}

/// Coefficients of a dimensionless force and moment given in mesh axes.
template <class T>
constexpr CoefficientsOf<T> coefficients_of(const Vec3Of<T>& force, const Vec3Of<T>& moment) {
  return {force.x, force.y, force.z, -moment.x, moment.y, -moment.z};
}

/// The same loads about a centre moved by `offset` (mesh axes, in reference lengths): M' = M - offset x F.
/// Along the axis that is Cm' = Cm + dx CN and Cn' = Cn + dx CY. Holds for loads, for their static and
/// acceleration derivatives; rate derivatives need more, see moment_transfer(DerivativeSet).
template <class T>
constexpr CoefficientsOf<T> moment_transfer(const CoefficientsOf<T>& about_old, const Vec3& offset) {
  const Vec3Of<T> force = about_old.force();
  return coefficients_of(force, about_old.moment() - cross(offset, force));
}

}  // namespace alphadot
