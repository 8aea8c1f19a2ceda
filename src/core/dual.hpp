// Forward automatic differentiation: a value with its derivatives in N directions.
#pragma once

#include <algorithm>
#include <cmath>

#include "core/directions.hpp"

namespace alphadot {

/// value + sum_k d[k] epsilon_k with epsilon_j epsilon_k = 0. Comparisons look at the value alone.
template <int N>
struct Dual {
  Real v{};
  Directions<N> d{};

  constexpr Dual() = default;
  constexpr Dual(Real value) : v(value) {}  // a constant: implicit, so that formulas mix freely

  constexpr Dual& operator+=(const Dual& b) {
    v += b.v;
    d += b.d;
    return *this;
  }
  constexpr Dual& operator-=(const Dual& b) {
    v -= b.v;
    d -= b.d;
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
  friend constexpr Dual operator+(Real a, const Dual& b) { return b + a; }
  friend constexpr Dual operator-(Dual a, Real b) {
    a.v -= b;
    return a;
  }
  friend constexpr Dual operator-(Real a, const Dual& b) { return {a - b.v, -b.d}; }
  friend constexpr Dual operator-(const Dual& a) { return {-a.v, -a.d}; }
  friend constexpr Dual operator*(Real a, const Dual& b) { return {a * b.v, a * b.d}; }
  friend constexpr Dual operator*(const Dual& a, Real b) { return b * a; }
  friend constexpr Dual operator*(const Dual& a, const Dual& b) { return {a.v * b.v, a.v * b.d + b.v * a.d}; }
  friend constexpr Dual operator/(const Dual& a, Real b) { return a * (1 / b); }
  friend constexpr Dual operator/(const Dual& a, const Dual& b) {
    const Real inverse = 1 / b.v, quotient = a.v * inverse;
    return {quotient, (a.d - quotient * b.d) * inverse};
  }
  friend constexpr Dual operator/(Real a, const Dual& b) { return {a / b.v, -a / (b.v * b.v) * b.d}; }

  friend constexpr bool operator<(const Dual& a, const Dual& b) { return a.v < b.v; }
  friend constexpr bool operator>(const Dual& a, const Dual& b) { return a.v > b.v; }
  friend constexpr bool operator<=(const Dual& a, const Dual& b) { return a.v <= b.v; }
  friend constexpr bool operator>=(const Dual& a, const Dual& b) { return a.v >= b.v; }

  friend Dual sqrt(const Dual& a) {
    const Real root = std::sqrt(a.v);
    return {root, 0.5 / root * a.d};
  }
  friend Dual pow(const Dual& a, Real exponent) {
    const Real value = std::pow(a.v, exponent);
    return {value, exponent * value / a.v * a.d};
  }
  friend constexpr Dual abs(const Dual& a) { return a.v < 0 ? -a : a; }

 private:
  constexpr Dual(Real value, const Directions<N>& derivatives) : v(value), d(derivatives) {}
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
