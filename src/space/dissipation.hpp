// What the numerical flux adds to the physical one on faces: the scheme's own error, where it is made.
#pragma once

#include <vector>

#include "space/conditions.hpp"
#include "space/flow_field.hpp"
#include "space/reconstruction.hpp"

namespace alphadot {

/// [faces] Of every interior face, from left to right: area times what the numerical flux between the states
/// reconstructed on its sides differs from the mean of their physical fluxes, -|A| (right - left) / 2 of
/// Roe's. It vanishes where the sides meet, as the square of the spacing in smooth flow. The ghosts of flow
/// and reconstruction must be current.
std::vector<Conserved<Real>> dissipation(const Discretization& discretization, const FlowField<Real>& flow,
                                         const Reconstruction<Real>& reconstruction,
                                         const Conditions<Real>& conditions);

}  // namespace alphadot
