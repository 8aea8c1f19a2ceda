// The flow as files for ParaView.
#pragma once

#include <string>

#include "derivatives/setup.hpp"
#include "march/implicit_iteration.hpp"

namespace alphadot {

/// Writes flow.vtkhdf (density, velocity, pressure, Mach number, Cp on cells) and surface.vtkhdf (Cp and
/// pressure on boundary faces) into `folder`, as the case asks. Collective.
void write_pictures(const std::string& folder, const Setup& setup, const ImplicitIteration& iteration,
                    const Origin& origin, const Communicator& comm);

}  // namespace alphadot
