// The choices that fluxes and boundary states leave.
#pragma once

#include "core/words.hpp"

namespace alphadot {

enum class FluxKind { roe, van_leer, hllc };

namespace words {
inline constexpr Word<FluxKind> flux[] = {
    {"roe", FluxKind::roe}, {"van_leer", FluxKind::van_leer}, {"hllc", FluxKind::hllc}};
}
template <>
inline constexpr std::span<const Word<FluxKind>> words_of<FluxKind> = words::flux;

/// How a patch of the boundary is treated.
/// wall: slip wall, counted in the forces. sting: slip wall left out of the forces. base_jet ("jet"): imposes
/// the free stream, left out of the forces. symmetry: slip plane. farfield: characteristic.
enum class BoundaryKind { wall, sting, jet, symmetry, farfield };

namespace words {
inline constexpr Word<BoundaryKind> boundary[] = {{"wall", BoundaryKind::wall},
                                                  {"sting", BoundaryKind::sting},
                                                  {"jet", BoundaryKind::jet},
                                                  {"symmetry", BoundaryKind::symmetry},
                                                  {"farfield", BoundaryKind::farfield}};
}
template <>
inline constexpr std::span<const Word<BoundaryKind>> words_of<BoundaryKind> = words::boundary;

}  // namespace alphadot
