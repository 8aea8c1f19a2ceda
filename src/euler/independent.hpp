// States as the variables by which the pure functions are differentiated.
#pragma once

#include "core/dual.hpp"
#include "euler/state.hpp"

namespace alphadot {

/// The state without derivatives.
template <int N>
Primitive<Dual<N>> constant(const Primitive<Real>& w) {
  Primitive<Dual<N>> out;
  for (int i = 0; i < 5; ++i) out[i] = w[i];
  return out;
}

/// The state with its entries as the first five of N variables.
template <int N>
Primitive<Dual<N>> independent(const Primitive<Real>& w) {
  auto out = constant<N>(w);
  for (int i = 0; i < 5; ++i) out[i].d[i] = 1;
  return out;
}

}  // namespace alphadot
