// A computed number together with how far it may be from the truth.
#pragma once

#include <cmath>

#include "core/types.hpp"

namespace alphadot {

/// A value and its uncertainty (half width, about 95 %; same unit as the value). In sums the uncertainties
/// add: the parts of one run are correlated in ways nobody knows, and this holds for every correlation.
struct Estimate {
  Real value = 0;
  Real uncertainty = 0;

  Estimate& operator+=(const Estimate& b) {
    value += b.value;
    uncertainty += b.uncertainty;
    return *this;
  }
};

inline Estimate operator+(Estimate a, const Estimate& b) {
  return a += b;
}
inline Estimate operator-(const Estimate& a) {
  return {-a.value, a.uncertainty};
}
inline Estimate operator-(const Estimate& a, const Estimate& b) {
  return a + -b;
}
/// None of what is unknown, an infinite uncertainty, is known.
inline Estimate operator*(Real s, const Estimate& a) {
  return {s * a.value, s == 0 ? 0 : std::abs(s) * a.uncertainty};
}

}  // namespace alphadot
