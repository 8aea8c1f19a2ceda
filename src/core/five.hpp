// Five numbers of one cell or face: a state, a flux or an update; and the 5 x 5 matrices between them.
#pragma once

#include "core/types.hpp"

namespace alphadot {

template <class T>
struct Five {
  T v[5]{};

  constexpr T& operator[](int i) { return v[i]; }
  constexpr const T& operator[](int i) const { return v[i]; }

  constexpr Five& operator+=(const Five& b) {
    for (int i = 0; i < 5; ++i) v[i] += b.v[i];
    return *this;
  }
  constexpr Five& operator-=(const Five& b) {
    for (int i = 0; i < 5; ++i) v[i] -= b.v[i];
    return *this;
  }
  friend constexpr Five operator+(Five a, const Five& b) { return a += b; }
  friend constexpr Five operator-(Five a, const Five& b) { return a -= b; }
  template <class S>
  friend constexpr Five operator*(const S& s, Five a) {
    for (int i = 0; i < 5; ++i) a.v[i] = s * a.v[i];
    return a;
  }
};

}  // namespace alphadot
