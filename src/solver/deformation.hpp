// A grid that follows the body near it and rests at the far field.
#pragma once

#include <array>
#include <vector>

#include "solver/moving_grid.hpp"

namespace alphadot {

/// Share of the body's displacement that each point of the domain takes part in: 1 on the body, 0 at the far
/// field, and in between a smooth function of r = d_body / (d_body + d_far), the distances being to the
/// nearest point of either: inverse-distance weighting by the nearest points alone. Cells near the body move
/// as a rigid whole. Symmetry planes take part like the interior. Collective.
std::vector<Real> follow_shares(const Subdomain& domain, const Discretization& discretization,
                                const Communicator& comm);

/// The volume that a triangle sweeps while its corners go straight from one place to another, positive along
/// its normal. Exact, so that over a closed cell the sum is the change of the cell's volume to round-off.
Real swept_volume(const std::array<Vec3, 3>& from, const std::array<Vec3, 3>& to);

/// Outer boundary fixed, inner grid with the body. Grid speeds are the swept volumes of the last two steps,
/// weighted as the time scheme weights its levels: with V0 U0, V1 U1, V2 U2 in the time derivative a uniform
/// flow is kept to round-off (discrete geometric conservation law; Lesoinne & Farhat 1996).
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
  std::vector<Vec3> points_at(int step) const;
  void find_speeds(int step, const std::array<std::vector<Vec3>, 3>& points);

  const Communicator& comm_;
  std::vector<Real> share_;                   // [points]
  std::array<std::vector<Real>, 3> volumes_;  // [levels][total_cells]
  FaceSpeeds speeds_;
};

}  // namespace alphadot
