// A gust on the mesh: speeds of the faces and sources in the cells.
#pragma once

#include "motion/gust.hpp"
#include "space/conditions.hpp"
#include "space/discretization.hpp"

namespace alphadot {

/// Its velocity enters as that of a grid that moves the other way (field velocity), as the mean over each
/// face: over an interval along x of the face's centre and variance.
class GustField {
 public:
  GustField(Gust gust, const Discretization& discretization);

  /// Lets the gust of `time` into the conditions of a body with that attitude, whose axis point has gone
  /// `travel`; they refer to this object until the next call.
  void enter(Conditions<Real>& conditions, const Attitude& attitude, const Vec3& travel, Real stream_speed,
             Real time);

 private:
  Gust gust_;
  const Discretization& discretization_;
  FaceSpeeds speeds_;
  GustInCells in_cells_;
};

}  // namespace alphadot
