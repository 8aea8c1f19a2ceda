// Where a body may disturb the stream around it.
#pragma once

#include "core/communicator.hpp"
#include "space/discretization.hpp"

namespace alphadot {

/// In a supersonic stream the smallest cone along the wind that holds the body, a quarter wider than the Mach
/// cone: the bow waves of slender bodies are less steep than that. In a subsonic stream, which a body
/// disturbs everywhere, the ball around it, where it does so most. Walls, jets and stings are the body;
/// without any it is a point at the origin.
class Influence {
 public:
  /// `wind` in units of the speed of sound. Collective.
  Influence(const Discretization& discretization, const Vec3& wind, const Communicator& comm);

  /// Distance from x to the nearest point that the body disturbs, 0 inside.
  Real distance(const Vec3& x) const;
  /// Diagonal of the box around the body.
  Real body_size() const { return body_size_; }

 private:
  Vec3 axis_;                   // unit vector along the wind
  Real sine_ = 0, cosine_ = 0;  // of the cone's half-angle; both 0: a ball
  Vec3 center_;                 // apex of the cone, or centre of the ball
  Real radius_ = 0;             // of the ball
  Real body_size_ = 0;
};

}  // namespace alphadot
