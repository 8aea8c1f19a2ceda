// The parts of a mesh that hang together.
#pragma once

#include <limits>
#include <vector>

#include "core/communicator.hpp"
#include "core/types.hpp"
#include "partition/box.hpp"
#include "partition/subdomain.hpp"

namespace alphadot {

/// Cells that can be reached from each other through faces.
struct Region {
  GlobalIndex cells = 0;
  GlobalIndex first_cell = std::numeric_limits<GlobalIndex>::max();  ///< the smallest global id
  Box box = empty_box();                                             ///< around its points
};

struct Regions {
  std::vector<Region> all;     ///< the same on every rank; most cells first, then by first_cell
  std::vector<Index> of_cell;  ///< [owned_cells] position in `all`
};

/// Finds them: every rank joins its own cells, the root what remains across cuts. One exchange of ghosts, and
/// a few numbers for every piece that a rank's part falls into. The same at any number of ranks. Collective.
Regions find_regions(const Subdomain& domain, const Communicator& comm);

}  // namespace alphadot
