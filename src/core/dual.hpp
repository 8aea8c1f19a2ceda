// Forward automatic differentiation: a value with its derivatives in N directions.
#pragma once

#include <algorithm>
#include <cmath>

#include "core/directions.hpp"

namespace alphadot {

/// value + sum_k d[k] epsilon_k with epsilon_j epsilon_k = 0. Comparisons look at the value alone. A loop
/// that lives on these numbers wants [[gnu::flatten]]: a call that is left in it passes them through memory,
/// which costs more than the arithmetic.
template <int N, class S = Real>
struct Dual {
  S v{};
  Directions<N, S> d{};

  constexpr Dual() = default;
  constexpr Dual(Real value)
      : v(static_cast<S>(value)) {}  // a constant: implicit, so that formulas mix freely

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
  friend constexpr Dual operator+(Dual a, S b) {
    a.v += b;
    return a;
  }
  friend constexpr Dual operator+(S a, const Dual& b) { return b + a; }
  friend constexpr Dual operator-(Dual a, S b) {
    a.v -= b;
    return a;
  }
  friend constexpr Dual operator-(S a, const Dual& b) { return {a - b.v, -b.d}; }
  friend constexpr Dual operator-(const Dual& a) { return {-a.v, -a.d}; }
  friend constexpr Dual operator*(S a, const Dual& b) { return {a * b.v, a * b.d}; }
  friend constexpr Dual operator*(const Dual& a, S b) { return b * a; }
  friend constexpr Dual operator*(const Dual& a, const Dual& b) { return {a.v * b.v, a.v * b.d + b.v * a.d}; }
  friend constexpr Dual operator/(const Dual& a, S b) { return a * (1 / b); }
  friend constexpr Dual operator/(const Dual& a, const Dual& b) {
    const S inverse = 1 / b.v, quotient = a.v * inverse;
    return {quotient, (a.d - quotient * b.d) * inverse};
  }
  friend constexpr Dual operator/(S a, const Dual& b) { return {a / b.v, -a / (b.v * b.v) * b.d}; }

  friend constexpr bool operator<(const Dual& a, const Dual& b) { return a.v < b.v; }
  friend constexpr bool operator>(const Dual& a, const Dual& b) { return a.v > b.v; }
  friend constexpr bool operator<=(const Dual& a, const Dual& b) { return a.v <= b.v; }
  friend constexpr bool operator>=(const Dual& a, const Dual& b) { return a.v >= b.v; }

  friend Dual sqrt(const Dual& a) {
    const S root = std::sqrt(a.v);
    return {root, S(0.5) / root * a.d};
  }
  friend Dual pow(const Dual& a, S exponent) {
    const S value = std::pow(a.v, exponent);
    return {value, exponent * value / a.v * a.d};
  }
  friend constexpr Dual abs(const Dual& a) { return a.v < 0 ? -a : a; }

 private:
  constexpr Dual(S value, const Directions<N, S>& derivatives) : v(value), d(derivatives) {}
};

/// The value without its derivatives, of a plain number or a dual one.
constexpr Real value_of(Real a) {
  return a;
}
template <int N, class S>
constexpr S value_of(const Dual<N, S>& a) {
  return a.v;
}

}  // namespace alphadot
