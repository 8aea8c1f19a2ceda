// Axis-parallel boxes around things.
#pragma once

#include <algorithm>
#include <limits>

#include "core/vec3.hpp"

namespace alphadot {

/// An axis-parallel box.
struct Box {
  Vec3 lower, upper;
};

/// A box around nothing yet.
inline Box empty_box() {
  constexpr Real infinite = std::numeric_limits<Real>::infinity();
  return {{infinite, infinite, infinite}, {-infinite, -infinite, -infinite}};
}

/// Makes the box hold a point or another box.
inline void extend(Box& box, const Vec3& at) {
  for (int d = 0; d < 3; ++d) {
    box.lower[d] = std::min(box.lower[d], at[d]);
    box.upper[d] = std::max(box.upper[d], at[d]);
  }
}
inline void extend(Box& box, const Box& other) {
  for (int d = 0; d < 3; ++d) {
    box.lower[d] = std::min(box.lower[d], other.lower[d]);
    box.upper[d] = std::max(box.upper[d], other.upper[d]);
  }
}

/// Whether `inner` lies in `outer`, on its sides perhaps.
inline bool contains(const Box& outer, const Box& inner) {
  for (int d = 0; d < 3; ++d)
    if (inner.lower[d] < outer.lower[d] || inner.upper[d] > outer.upper[d]) return false;
  return true;
}

}  // namespace alphadot
