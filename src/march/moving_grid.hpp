// Grids whose points move with the body: as a rigid whole, or blended to rest at the far field.
#pragma once

#include <vector>

#include "march/treatment.hpp"

namespace alphadot {

/// Place of the body at one moment, as a map from where its points are at rest.
struct BodyPlace {
  Vec3 axis_point;  ///< at rest
  Vec3 travel, angle;

  Vec3 carried(const Vec3& x) const { return axis_point + travel + on_turned_axes(x - axis_point, -angle); }
};

/// What all moving grids share. The state is along axes fixed in space.
class MovingGrid : public Treatment {
 public:
  MovingGrid(const Motion& motion, const Vec3& axis_point, Real time_step, Subdomain& domain,
             Discretization& discretization);

  Vec3 axes(const Attitude&) const override { return {}; }
  Load on_body(const Load& load, const Vec3& center) const override;

 protected:
  /// The body is at rest up to level 0. From there on it travels by the time scheme's own integral of its
  /// velocity, so that the difference of places which the scheme takes is the velocity and not an
  /// approximation of second order: in a uniform stream the velocity acts on the flow, the place does not.
  BodyPlace place(int step);
  /// Lets metrics and reconstruction follow the points of the domain.
  void renew_geometry();

  Real weights_step_;  // as the march's
  Subdomain& domain_;
  Discretization& discretization_;
  std::vector<Vec3> rest_;       // [points] before the motion
  std::vector<Vec3> travel_{1};  // [levels] of the axis point, as far as it was asked for
  BodyPlace now_;
};

/// The whole grid moves with the body. Grid speeds are those of a rigid body at the face centroids, which
/// cancel over every closed cell: the geometric conservation law holds to round-off.
class RigidGrid final : public MovingGrid {
 public:
  using MovingGrid::MovingGrid;

  Conditions<Real> move_to(int step) override;
  std::span<const Real> volumes(int) const override { return domain_.volume; }
};

}  // namespace alphadot
