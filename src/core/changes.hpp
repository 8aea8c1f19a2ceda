// Numbers that go through linear arithmetic several at a time.
#pragma once

#include "core/directions.hpp"

namespace alphadot {

/// The changes of one number in N directions. What is linear in a number can be done to its changes: sums,
/// and products with plain numbers.
template <int N>
struct Changes {
  Directions<N> d{};

  constexpr Changes& operator+=(const Changes& b) {
    d += b.d;
    return *this;
  }
  constexpr Changes& operator-=(const Changes& b) {
    d -= b.d;
    return *this;
  }
  friend constexpr Changes operator+(Changes a, const Changes& b) { return a += b; }
  friend constexpr Changes operator-(Changes a, const Changes& b) { return a -= b; }
  friend constexpr Changes operator*(Real a, Changes b) {
    b.d *= a;
    return b;
  }
  friend constexpr Changes operator*(const Changes& b, Real a) { return a * b; }
};

template <class T>
inline constexpr bool is_change = false;
template <int N>
inline constexpr bool is_change<Changes<N>> = true;

}  // namespace alphadot
