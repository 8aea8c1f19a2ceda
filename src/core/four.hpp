// Four numbers that are worked on together; plain ones fill a vector register.
#pragma once

#include <algorithm>
#include <array>
#include <cstring>
#include <type_traits>

#include "core/types.hpp"

namespace alphadot {

/// Vectors as GCC and Clang have them: arithmetic, comparison and choice element by element, on any
/// processor.
using FourReals = Real __attribute__((vector_size(4 * sizeof(Real))));

/// For changes of several problems, which no register holds: the part of the arithmetic that the solver uses.
template <class T>
struct FourOf {
  std::array<T, 4> v{};

  T& operator[](std::size_t k) { return v[k]; }
  const T& operator[](std::size_t k) const { return v[k]; }
  FourOf& operator+=(const FourOf& b) {
    for (std::size_t k = 0; k < 4; ++k) v[k] += b.v[k];
    return *this;
  }
  FourOf& operator-=(const FourOf& b) {
    for (std::size_t k = 0; k < 4; ++k) v[k] -= b.v[k];
    return *this;
  }
};

/// a b, element by element.
inline FourReals times(const FourReals& a, Real b) {
  return a * b;
}
template <class T>
FourOf<T> times(const FourReals& a, const T& b) {
  FourOf<T> out;
  for (std::size_t k = 0; k < 4; ++k) out.v[k] = a[k] * b;
  return out;
}

template <class T>
using Four = std::conditional_t<std::is_same_v<T, Real>, FourReals, FourOf<T>>;

/// The same number four times.
inline FourReals four(Real all) {
  return FourReals{} + all;
}

/// From consecutive places in memory, and back.
inline FourReals load_four(const Real* from) {
  FourReals out;
  std::memcpy(&out, from, sizeof(out));
  return out;
}
inline void store_four(const FourReals& from, Real* to) {
  std::memcpy(to, &from, sizeof(from));
}

/// Element by element.
inline FourReals minimum(const FourReals& a, const FourReals& b) {
  return a < b ? a : b;
}
inline FourReals maximum(const FourReals& a, const FourReals& b) {
  return a > b ? a : b;
}

/// Of the four elements.
inline Real smallest_of(const FourReals& a) {
  return std::min(std::min(a[0], a[1]), std::min(a[2], a[3]));
}
inline Real largest_of(const FourReals& a) {
  return std::max(std::max(a[0], a[1]), std::max(a[2], a[3]));
}

}  // namespace alphadot
