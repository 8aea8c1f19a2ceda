// Numbers in N directions, worked on together in the processor's registers.
#pragma once

#include <algorithm>
#include <bit>

#include "core/types.hpp"

namespace alphadot {

/// How many bytes one vector register of the processor holds. A longer vector would go through memory at
/// every operation.
#if defined(__AVX512F__)
inline constexpr int register_bytes = 64;
#elif defined(__AVX__)
inline constexpr int register_bytes = 32;
#else
inline constexpr int register_bytes = 16;
#endif

/// N numbers, added and scaled element by element; with unused ones at the end up to whole registers.
template <int N, class S = Real>
class Directions {
 public:
  S& operator[](int k) { return reinterpret_cast<S*>(registers_)[k]; }
  const S& operator[](int k) const { return reinterpret_cast<const S*>(registers_)[k]; }

  constexpr Directions& operator+=(const Directions& b) {
    for (std::size_t i = 0; i < count; ++i) registers_[i] += b.registers_[i];
    return *this;
  }
  constexpr Directions& operator-=(const Directions& b) {
    for (std::size_t i = 0; i < count; ++i) registers_[i] -= b.registers_[i];
    return *this;
  }
  constexpr Directions& operator*=(S a) {
    for (std::size_t i = 0; i < count; ++i) registers_[i] *= a;
    return *this;
  }
  friend constexpr Directions operator+(Directions a, const Directions& b) { return a += b; }
  friend constexpr Directions operator-(Directions a, const Directions& b) { return a -= b; }
  friend constexpr Directions operator-(Directions a) { return a *= -1; }
  friend constexpr Directions operator*(S a, Directions b) { return b *= a; }
  friend constexpr Directions operator*(Directions b, S a) { return b *= a; }

 private:
  static constexpr int size = static_cast<int>(sizeof(S));
  static constexpr int width =
      std::min(register_bytes / size, static_cast<int>(std::bit_ceil(static_cast<unsigned>(N))));
  static constexpr std::size_t count = (N + width - 1) / width;
  using Register __attribute__((vector_size(width * size), aligned(alignof(S)))) = S;

  Register registers_[count]{};
};

}  // namespace alphadot
