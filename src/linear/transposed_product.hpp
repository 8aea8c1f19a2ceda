// Products with the transposes of what a linearisation holds.
#pragma once

#include "linear/linearisation.hpp"

namespace alphadot {

/// A^T x, A column by column; X: a number or its changes.
template <class X>
Five<X> transposed_product(const Linearisation::Matrix& a, const Five<X>& x) {
  Five<X> out{};
  for (int column = 0; column < 5; ++column)
    for (int row = 0; row < 5; ++row) out[column] += a[static_cast<std::size_t>(5 * column + row)] * x[row];
  return out;
}

/// a . x
template <class X>
X product(const Five<Real>& a, const Five<X>& x) {
  X out{};
  for (int row = 0; row < 5; ++row) out += a[row] * x[row];
  return out;
}

}  // namespace alphadot
