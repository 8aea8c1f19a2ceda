// The cells in the lee of walls that face aft.
#pragma once

#include <cstdint>
#include <vector>

#include "core/communicator.hpp"
#include "space/discretization.hpp"

namespace alphadot {

/// Marks, [total_cells], the cells that touch a wall or sting which looks aft (partition/aft_faces.hpp) and
/// whose centroids lie further aft than the point that touches it: behind blunt trailing edges, steps and
/// bases that are walls, not beside them. A supersonic stream of inviscid gas leaves these at once, and
/// fluxes that let slip lines slip (Roe, HLLC) do not fill what stays behind: it becomes a vacuum. The same
/// cells at any incidence and on any number of ranks. Collective.
std::vector<std::uint8_t> lee_cells(const Discretization& discretization, const Communicator& comm);

}  // namespace alphadot
