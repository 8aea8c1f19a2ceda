// Numbers that go through linear arithmetic several at a time.
#pragma once

#include <bit>

#include "core/types.hpp"

namespace alphadot {

/// The changes of one number in N directions. What is linear in a number can be done to its changes: sums,
/// and products with plain numbers. They lie in one vector of the processor.
template <int N>
struct Changes {
  static constexpr int lanes = static_cast<int>(std::bit_ceil(static_cast<unsigned>(N)));
  using Vector __attribute__((vector_size(lanes * static_cast<int>(sizeof(Real))), aligned(alignof(Real)))) =
      Real;

  Vector d{};

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
