// A small vector in space, templated on its scalar so that derivatives can be carried along.
#pragma once

#include <cmath>

#include "core/types.hpp"

namespace alphadot {

template <class T>
struct Vec3Of {
  T x{}, y{}, z{};

  constexpr T& operator[](int i) { return i == 0 ? x : i == 1 ? y : z; }
  constexpr const T& operator[](int i) const { return i == 0 ? x : i == 1 ? y : z; }

  constexpr bool operator==(const Vec3Of&) const = default;
  constexpr Vec3Of& operator+=(const Vec3Of& b) {
    x += b.x;
    y += b.y;
    z += b.z;
    return *this;
  }
  constexpr Vec3Of& operator-=(const Vec3Of& b) {
    x -= b.x;
    y -= b.y;
    z -= b.z;
    return *this;
  }
};

using Vec3 = Vec3Of<Real>;

template <class A, class B>
constexpr auto operator+(const Vec3Of<A>& a, const Vec3Of<B>& b) -> Vec3Of<decltype(a.x + b.x)> {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
template <class A, class B>
constexpr auto operator-(const Vec3Of<A>& a, const Vec3Of<B>& b) -> Vec3Of<decltype(a.x - b.x)> {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <class T>
constexpr Vec3Of<T> operator-(const Vec3Of<T>& a) {
  return {-a.x, -a.y, -a.z};
}
template <class S, class T>
constexpr auto operator*(const S& s, const Vec3Of<T>& a) -> Vec3Of<decltype(s * a.x)> {
  return {s * a.x, s * a.y, s * a.z};
}
template <class A, class B>
constexpr auto dot(const Vec3Of<A>& a, const Vec3Of<B>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class A, class B>
constexpr auto cross(const Vec3Of<A>& a, const Vec3Of<B>& b) -> Vec3Of<decltype(a.x * b.x)> {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline Real norm(const Vec3& a) {
  return std::sqrt(dot(a, a));
}

}  // namespace alphadot
