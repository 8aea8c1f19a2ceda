// How a mesh follows walls that turn about a hinge.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "core/communicator.hpp"
#include "space/discretization.hpp"

namespace alphadot {

struct Hinge {
  Vec3 point;
  Vec3 axis;  ///< a unit vector; a deflection is positive by the right-hand rule about it
};

/// Displacement of every point of a mesh for a deflection of 1 rad, to first order.
struct Deflection {
  std::vector<Vec3> displacement;  ///< [points]
  /// The largest share, of the largest displacement of the walls that turn, of what these lose where they
  /// meet others: at walls that stay, and at planes of symmetry.
  Real lost_at_walls = 0, lost_at_symmetry = 0;
  Real hinge_distance = 0;  ///< of the hinge line from the box around the walls, over that box's diagonal
};

/// The walls of some patches turn as a rigid whole. Around them the mesh turns with them inside the box
/// around them, along the hinge and flat as they are, and comes to rest within half the diagonal of that box,
/// with two continuous derivatives. Points of all other patches slide along these: along the root of a fin,
/// and where the fin is near; along an edge where two sides meet. What keeps them there is smoothed over a
/// few cells. Collective.
Deflection deflection(const Discretization& discretization, std::span<const std::string> patches,
                      const Hinge& hinge, const Communicator& comm);

/// Turns the walls by an angle, rad, and the mesh with them: along the displacements for small deflections of
/// the mesh as it is meanwhile. `domain` is that of `discretization`. False when a cell would fold: the mesh
/// is then of no more use. Collective.
bool deflect(Subdomain& domain, Discretization& discretization, std::span<const std::string> patches,
             const Hinge& hinge, Real angle, const Communicator& comm);

}  // namespace alphadot
