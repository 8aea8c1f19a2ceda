// How fast signals cross a moving face.
#pragma once

#include <cmath>
#include <vector>

#include "euler/state_change.hpp"
#include "space/conditions.hpp"
#include "space/discretization.hpp"
#include "space/flow_field.hpp"

namespace alphadot {

/// Spectral radius |u.n - vg| + a of the flux Jacobian.
inline Real spectral_radius(const Primitive<Real>& w, const Vec3& normal, Real grid_speed, Real gamma) {
  return std::abs(dot(velocity(w), normal) - grid_speed) + sound_speed(w, gamma);
}

/// [owned_cells] sum over the faces of a cell of area times spectral radius: V / dtau at a CFL number of one.
std::vector<Real> wave_speeds(const Discretization& discretization, const FlowField<Real>& flow,
                              const Conditions<Real>& conditions);

}  // namespace alphadot
