// Numbers in N directions, worked on together in the processor's registers.
#pragma once

#include <algorithm>
#include <bit>

#include "core/types.hpp"

namespace alphadot {

/// How many numbers one vector register of the processor holds. A longer vector would go through memory at
/// every operation.
#if defined(__AVX512F__)
inline constexpr int register_lanes = 8;
#elif defined(__AVX__)
inline constexpr int register_lanes = 4;
#else
inline constexpr int register_lanes = 2;
#endif

/// N numbers, added and scaled element by element; with unused ones at the end up to whole registers.
template <int N>
class Directions {
 public:
  Real& operator[](int k) { return reinterpret_cast<Real*>(registers_)[k]; }
  const Real& operator[](int k) const { return reinterpret_cast<const Real*>(registers_)[k]; }

  constexpr Directions& operator+=(const Directions& b) {
    for (std::size_t i = 0; i < count; ++i) registers_[i] += b.registers_[i];
    return *this;
  }
  constexpr Directions& operator-=(const Directions& b) {
    for (std::size_t i = 0; i < count; ++i) registers_[i] -= b.registers_[i];
    return *this;
  }
  constexpr Directions& operator*=(Real a) {
    for (std::size_t i = 0; i < count; ++i) registers_[i] *= a;
    return *this;
  }
  friend constexpr Directions operator+(Directions a, const Directions& b) { return a += b; }
  friend constexpr Directions operator-(Directions a, const Directions& b) { return a -= b; }
  friend constexpr Directions operator-(Directions a) { return a *= -1; }
  friend constexpr Directions operator*(Real a, Directions b) { return b *= a; }
  friend constexpr Directions operator*(Directions b, Real a) { return b *= a; }

 private:
  static constexpr int width =
      std::min(register_lanes, static_cast<int>(std::bit_ceil(static_cast<unsigned>(N))));
  static constexpr std::size_t count = (N + width - 1) / width;
  using Register
      __attribute__((vector_size(width * static_cast<int>(sizeof(Real))), aligned(alignof(Real)))) = Real;

  Register registers_[count]{};
};

}  // namespace alphadot
