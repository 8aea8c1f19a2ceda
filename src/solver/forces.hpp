// Pressure forces on the walls.
#pragma once

#include <vector>

#include "solver/residual.hpp"

namespace alphadot {

/// Force and moment of one patch, in units of rho_inf a_inf^2 times length^2 (^3), along mesh axes.
struct Load {
  Vec3 force, moment;

  Load& operator+=(const Load& b) {
    force += b.force;
    moment += b.moment;
    return *this;
  }
  friend Load operator-(const Load& a, const Load& b) { return {a.force - b.force, a.moment - b.moment}; }
  friend Load operator*(Real s, const Load& a) { return {s * a.force, s * a.moment}; }
};

/// Load of every patch that is a wall (zero for others): integral of (p - p_inf) n, moments about `center`.
/// Summed over this rank only; the sum over ranks is the caller's, together with its other numbers.
std::vector<Load> wall_loads(const Discretization& discretization, const Residual<Real>& residual,
                             const FlowField<Real>& flow, int order, const Vec3& center);

}  // namespace alphadot
