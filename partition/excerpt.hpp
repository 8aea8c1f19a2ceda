// A few cells of a subdomain with all that belongs to them: a small subdomain of its own.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/communicator.hpp"
#include "partition/subdomain.hpp"

namespace alphadot {

/// How many cells, from point to point, lie between each cell and the nearest of those marked: 0 for these
/// themselves, `most` + 1 where there are more than `most`. `marked`: [owned_cells]; the result:
/// [total_cells]. Collective.
std::vector<std::uint8_t> rings_around(const Subdomain& domain, std::span<const std::uint8_t> marked,
                                       int most, const Communicator& comm);

/// Cells that lie at its edge lack the neighbours that are not in it, and the faces towards them.
struct Excerpt {
  Subdomain domain;
  /// What its cells, points and boundary faces are in the subdomain that it is of.
  std::vector<Index> cells, points, boundary_faces;
};

/// The cells that are kept, [total_cells], the same for a ghost and its owner, in their order. Every rank has
/// to keep one.
Excerpt excerpt_of(const Subdomain& domain, std::span<const std::uint8_t> kept);

}  // namespace alphadot
