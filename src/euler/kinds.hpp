// The choices that fluxes and boundary states leave.
#pragma once

namespace alphadot {

enum class FluxKind { roe, van_leer, hllc };

/// How a patch of the boundary is treated.
/// wall: slip wall, counted in the forces. sting: slip wall left out of the forces. base_jet ("jet"): imposes
/// the free stream, left out of the forces. symmetry: slip plane. farfield: characteristic.
enum class BoundaryKind { wall, sting, jet, symmetry, farfield };

}  // namespace alphadot
