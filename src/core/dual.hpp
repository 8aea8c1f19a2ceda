// Forward automatic differentiation: a value with its derivatives in N directions.
#pragma once

#include <algorithm>
#include <cmath>

#include "core/types.hpp"

namespace alphadot {

/// value + sum_k d[k] epsilon_k with epsilon_j epsilon_k = 0. Comparisons look at the value alone.
template <int N>
struct Dual {
  Real v{};
  Real d[N]{};

  constexpr Dual() = default;
  constexpr Dual(Real value) : v(value) {}  // a constant: implicit, so that formulas mix freely

  constexpr Dual& operator+=(const Dual& b) {
    v += b.v;
    for (int k = 0; k < N; ++k) d[k] += b.d[k];
    return *this;
  }
  constexpr Dual& operator-=(const Dual& b) {
    v -= b.v;
    for (int k = 0; k < N; ++k) d[k] -= b.d[k];
    return *this;
  }
  constexpr Dual& operator*=(const Dual& b) { return *this = *this * b; }
  constexpr Dual& operator/=(const Dual& b) { return *this = *this / b; }

  friend constexpr Dual operator+(Dual a, const Dual& b) { return a += b; }
  friend constexpr Dual operator-(Dual a, const Dual& b) { return a -= b; }
  friend constexpr Dual operator+(Dual a, Real b) {
    a.v += b;
    return a;
  }
  friend constexpr Dual operator+(Real a, Dual b) { return b + a; }
  friend constexpr Dual operator-(Dual a, Real b) {
    a.v -= b;
    return a;
  }
  friend constexpr Dual operator-(Real a, const Dual& b) { return -b + a; }
  friend constexpr Dual operator-(const Dual& a) { return scaled(a, -a.v, -1.0); }
  friend constexpr Dual operator*(Real a, const Dual& b) { return scaled(b, a * b.v, a); }
  friend constexpr Dual operator*(const Dual& a, Real b) { return b * a; }
  friend constexpr Dual operator*(const Dual& a, const Dual& b) {
    Dual out;
    out.v = a.v * b.v;
    for (int k = 0; k < N; ++k) out.d[k] = a.v * b.d[k] + b.v * a.d[k];
    return out;
  }
  friend constexpr Dual operator/(const Dual& a, Real b) { return a * (1 / b); }
  friend constexpr Dual operator/(const Dual& a, const Dual& b) {
    Dual out;
    const Real inverse = 1 / b.v;
    out.v = a.v * inverse;
    for (int k = 0; k < N; ++k) out.d[k] = (a.d[k] - out.v * b.d[k]) * inverse;
    return out;
  }
  friend constexpr Dual operator/(Real a, const Dual& b) { return scaled(b, a / b.v, -a / (b.v * b.v)); }

  friend constexpr bool operator<(const Dual& a, const Dual& b) { return a.v < b.v; }
  friend constexpr bool operator>(const Dual& a, const Dual& b) { return a.v > b.v; }
  friend constexpr bool operator<=(const Dual& a, const Dual& b) { return a.v <= b.v; }
  friend constexpr bool operator>=(const Dual& a, const Dual& b) { return a.v >= b.v; }

  friend Dual sqrt(const Dual& a) {
    const Real root = std::sqrt(a.v);
    return scaled(a, root, 0.5 / root);
  }
  friend Dual pow(const Dual& a, Real exponent) {
    const Real value = std::pow(a.v, exponent);
    return scaled(a, value, exponent * value / a.v);
  }
  friend constexpr Dual abs(const Dual& a) { return a.v < 0 ? -a : a; }

 private:
  /// f(a) with value f and slope f'.
  static constexpr Dual scaled(const Dual& a, Real value, Real slope) {
    Dual out;
    out.v = value;
    for (int k = 0; k < N; ++k) out.d[k] = slope * a.d[k];
    return out;
  }
};

/// The value without its derivatives, of a plain number or a dual one.
constexpr Real value_of(Real a) {
  return a;
}
template <int N>
constexpr Real value_of(const Dual<N>& a) {
  return a.v;
}

}  // namespace alphadot
