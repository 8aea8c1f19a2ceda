// A box case whose mesh may move, and a march on it.
#pragma once

#include <algorithm>
#include <memory>

#include "linear/block_lu_sgs.hpp"
#include "march/dual_time.hpp"
#include "support/box_case.hpp"

namespace alphadot::testing_support {

inline constexpr TreatmentKind all_treatments[] = {TreatmentKind::field_velocity, TreatmentKind::rigid_grid,
                                                   TreatmentKind::deforming_grid};

inline const Vec3 box_axis_point{0.4, 0.5, 2.2};

inline Motion box_motion(MotionKind kind, Real amplitude = 3, Real reduced_frequency = 0.3) {
  MotionSettings settings;
  settings.kind = kind;
  settings.amplitude = amplitude;
  settings.reduced_frequency = reduced_frequency;
  return Motion(settings, {.mach = 1.58, .alpha = 2, .beta = 1, .gamma = gamma_air}, 1, 10);
}

/// Mesh, flow and march of one treatment.
class MovingBox {
 public:
  MovingBox(const BoxSides& sides, const SpaceSettings& space, const Motion& motion, TreatmentKind treatment,
            Real time_step)
      : motion_(motion),
        treatment_(treatment),
        time_step_(time_step),
        domain(distribute(small_box(), comm)),
        discretization(domain, {sides.begin(), sides.end()}, space, gamma_air),
        iteration(discretization, comm, std::make_unique<BlockLuSgs>(discretization, comm, 8),
                  box_axis_point + Vec3{0.3, 0, 0.1}) {
    iteration.set_uniform(free_stream(motion.wind(), gamma_air));
  }
  MovingBox(const MovingBox&) = delete;
  MovingBox& operator=(const MovingBox&) = delete;

  /// Begins the march from the flow that is in place.
  void start() {
    march = std::make_unique<DualTime>(
        iteration, motion_, box_axis_point, time_step_, Load{},
        make_treatment(treatment_, motion_, box_axis_point, time_step_, domain, discretization, comm));
  }
  /// A step converged to round-off.
  StepReport advance(int iterations = 40) {
    return march->advance({.share = 0, .amplitude = 1, .max_iterations = iterations});
  }
  /// Largest difference of the flow from a uniform one.
  Real distance_from(const Primitive<Real>& state) const {
    Real worst = 0;
    for (Index cell = 0; cell < domain.owned_cells; ++cell)
      for (int i = 0; i < 5; ++i) worst = std::max(worst, std::abs(iteration.flow()[cell][i] - state[i]));
    return comm.max(worst);
  }

 private:
  const Motion& motion_;
  TreatmentKind treatment_;
  Real time_step_;

 public:
  const Communicator comm;
  Subdomain domain;
  Discretization discretization;
  ImplicitIteration iteration;
  std::unique_ptr<DualTime> march;
};

/// Largest difference of two loads, relative to the largest entry of the first.
inline Real relative_difference(const Load& a, const Load& b) {
  Real size = 0, difference = 0;
  for (int i = 0; i < 3; ++i) {
    size = std::max({size, std::abs(a.force[i]), std::abs(a.moment[i])});
    difference =
        std::max({difference, std::abs(a.force[i] - b.force[i]), std::abs(a.moment[i] - b.moment[i])});
  }
  return difference / size;
}

}  // namespace alphadot::testing_support
