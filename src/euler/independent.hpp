// States as the variables by which the pure functions are differentiated.
#pragma once

#include "core/dual.hpp"
#include "euler/state.hpp"

namespace alphadot {

/// The state without derivatives.
template <int N, class S = Real>
Primitive<Dual<N, S>> constant(const Primitive<Real>& w) {
  Primitive<Dual<N, S>> out;
  for (int i = 0; i < 5; ++i) out[i] = w[i];
  return out;
}

/// The state with its entries as five of N variables, from number `first` on.
template <int N, class S = Real>
Primitive<Dual<N, S>> independent(const Primitive<Real>& w, int first = 0) {
  auto out = constant<N, S>(w);
  for (int i = 0; i < 5; ++i) out[i].d[first + i] = 1;
  return out;
}

}  // namespace alphadot
