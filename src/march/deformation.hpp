// A grid that follows the body where the flow is disturbed and comes to rest outside.
#pragma once

#include <array>
#include <vector>

#include "march/moving_grid.hpp"

namespace alphadot {

/// Share of the body's displacement that each point of the domain takes part in: 1 where the body disturbs
/// the flow, the boundary included; from there it falls smoothly with the distance, over a length that is the
/// larger of the body's size and the farthest distance that the domain has, where it is 0. Cells then deform
/// in the undisturbed stream only, and there a deformation that conserves the stream makes no error, while an
/// error in the disturbed flow is one in the loads: in phase with the travel, that is with the rate of the
/// incidence, it would enter its derivative divided by k. Collective.
std::vector<Real> follow_shares(const Discretization& discretization, const Vec3& wind,
                                const Communicator& comm);

/// The volume that a triangle sweeps while its corners go straight from one place to another, positive along
/// its normal. Exact, so that over a closed cell the sum is the change of the cell's volume to round-off.
Real swept_volume(const std::array<Vec3, 3>& from, const std::array<Vec3, 3>& to);

/// Disturbed flow with the body, the far stream at rest. Grid speeds are the swept volumes of the last two
/// steps, weighted as the time scheme weights its levels: with V0 U0, V1 U1, V2 U2 in the time derivative a
/// uniform flow is kept to round-off (discrete geometric conservation law; Lesoinne & Farhat 1996).
class DeformingGrid final : public MovingGrid {
 public:
  DeformingGrid(const Motion& motion, const Vec3& axis_point, Real time_step, Subdomain& domain,
                Discretization& discretization, const Communicator& comm);

  /// Throws DivergedError on all ranks when a cell would fold.
  Conditions<Real> move_to(int step) override;
  std::span<const Real> volumes(int levels_back) const override {
    return volumes_[static_cast<std::size_t>(levels_back)];
  }

 private:
  std::vector<Vec3> points_at(int step);
  void find_speeds(int step, const std::array<std::vector<Vec3>, 3>& points);

  const Communicator& comm_;
  std::vector<Real> share_;                   // [points]
  std::array<std::vector<Real>, 3> volumes_;  // [levels][total_cells]
  FaceSpeeds speeds_;
};

}  // namespace alphadot
