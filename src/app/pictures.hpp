// The flow as files for ParaView.
#pragma once

#include <string>

#include "derivatives/linear_derivatives.hpp"
#include "derivatives/setup.hpp"
#include "march/implicit_iteration.hpp"

namespace alphadot {

/// Writes into `folder`, as the case asks: flow.vtkhdf (density, velocity, pressure, Mach number, Cp on
/// cells), surface.vtkhdf (pressure, Cp and the fields of `more` on walls, jets and stings) and, of a mesh
/// with planes of symmetry, symmetry.vtkhdf (pressure and Cp on these). Collective.
void write_pictures(const std::string& folder, const Setup& setup, const ImplicitIteration& iteration,
                    const FieldsOnFaces& more, const Origin& origin, const Communicator& comm);

}  // namespace alphadot
