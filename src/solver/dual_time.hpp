// Time-accurate march: second-order backward differences, each step converged in pseudo time.
#pragma once

#include <functional>
#include <vector>

#include "motion/motion.hpp"
#include "solver/implicit_iteration.hpp"
#include "solver/steady.hpp"

namespace alphadot {

/// One physical step, passed to the observer when its inner iterations have ended.
struct StepReport {
  int step;
  Real time;
  Attitude attitude;
  int inner_iterations;
  Real inner_orders;  ///< decades that the unsteady density residual dropped within the step
  Real moment_error;  ///< estimate of what is left in the pitching moment (in units of the load) by stopping
                      ///< here
  FlowReport report;
};

/// When a step's inner iterations may end: the moment's remaining error, extrapolated from the rate at which
/// its changes shrink, must fall below this. In units of the load's moment.
struct InnerTolerance {
  Real moment;
  int max_iterations;
};

class DualTime {
 public:
  /// Starts from the flow in `iteration`, taken as steady for all times before t = 0.
  DualTime(ImplicitIteration& iteration, const Motion& motion, const Vec3& axis_point, Real time_step);

  /// One step of BDF2: V (3 U - 4 U^n + U^(n-1)) / (2 dt) + R(U) = 0. Throws DivergedError when a state turns
  /// unphysical.
  StepReport advance(const InnerTolerance& tolerance);

  int step() const { return step_; }
  Real time() const { return step_ * time_step_; }
  std::size_t bytes() const { return 2 * old_.size() * sizeof(old_[0]); }

 private:
  void predict();
  void add_time_derivative();

  ImplicitIteration& iteration_;
  const Motion& motion_;
  Vec3 axis_point_;
  Real time_step_;
  int step_ = 0;
  std::vector<Conserved<Real>> old_, older_;  // [owned_cells] U^n, U^(n-1)
};

}  // namespace alphadot
