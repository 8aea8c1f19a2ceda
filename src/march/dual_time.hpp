// Time-accurate march: second-order backward differences, each step converged in pseudo time.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "march/implicit_iteration.hpp"
#include "march/steady.hpp"
#include "march/treatment.hpp"
#include "motion/motion.hpp"

namespace alphadot {

/// One physical step, passed to the observer when its inner iterations have ended.
struct StepReport {
  int step = 0;
  Real time = 0;
  Attitude attitude;
  int inner_iterations = 0;
  Real inner_orders = 0;  ///< decades that the unsteady density residual dropped within the step
  Load error;             ///< estimate of what is left in force and moment by stopping here
  Real inner_left = 0;    ///< that of the moment over what the tolerance allows; up to 1 it was reached
  FlowReport report;      ///< loads on body axes
};

/// When a step's inner iterations may end. The part of the moment that is out of phase with the angle is
/// about k times the part in phase, so the moment itself must be converged to a small share of that: its
/// remaining error, extrapolated from the rate at which its changes shrink, must fall below `share` times the
/// largest deviation of the moment that the motion's full amplitude would cause.
struct InnerTolerance {
  Real share;      ///< reduced frequency times the tolerance of the out-of-phase part
  Real amplitude;  ///< rad, of the driven angle
  int max_iterations;
};

/// What a march needs, besides the flow and its two old levels, to go on exactly as if it had not stopped.
struct DualTimeState {
  int step = 0;
  Real largest_angle = 0, largest_moment = 0;
};

/// Time-accurate march along a motion, in any treatment of it.
///
/// The old time levels are kept along axes fixed in space and turned onto those of the solution in every
/// step: V (3 U - 4 Q U^n + Q U^(n-1)) / (2 dt) + R(U) = 0 with the rotation Q applied to momenta. On body
/// axes this takes the place of the source -rho Omega x u, and makes a field velocity the same set of
/// discrete equations as a grid that moves rigidly.
class DualTime {
 public:
  /// Starts from the flow in `iteration`, taken as steady for all times before t = 0, with `initial` its
  /// loads. Without a treatment: field velocity.
  DualTime(ImplicitIteration& iteration, const Motion& motion, const Vec3& axis_point, Real time_step,
           const Load& initial, std::unique_ptr<Treatment> treatment = nullptr);

  /// The steady flow before the motion, as step 0.
  StepReport before() const;
  /// The loads just after t = 0, when the motion sets in with a jump of velocity: every wall has started to
  /// move, the gas on it has not (see wall_pressure).
  StepReport just_after_start() const;

  /// One step of BDF2 (backward Euler for the first), fitted to the frequency of a harmonic motion. It ends
  /// when the moment is within the tolerance, the inner iterations are used up, or the residual has come to a
  /// stall, as where a limiter never rests; the report holds the error that is left. A body that flies freely
  /// answers the loads in every one of them. Throws DivergedError when a state turns unphysical.
  StepReport advance(const InnerTolerance& tolerance);

  int step() const { return state_.step; }
  Real time() const { return state_.step * time_step_; }

  /// For checkpoints: [owned_cells] conserved states of the latest step and the one before, momenta along
  /// axes fixed in space; the flow itself is primitive and along the axes of the solution.
  std::span<Conserved<Real>> latest_level() { return old_; }
  std::span<Conserved<Real>> level_before() { return older_; }
  const DualTimeState& state() const { return state_; }
  /// Goes on from a state whose levels and flow have been put in place.
  void restore(const DualTimeState& state) { state_ = state; }

  std::size_t bytes() const { return 2 * old_.size() * sizeof(old_[0]); }

 private:
  void predict(const Vec3& axes);
  void add_time_derivative(const Vec3& axes);
  void keep_levels(const Vec3& axes);
  /// Loads on body axes.
  FlowReport report() const;
  /// Largest deviation of the moment seen, scaled to the full amplitude.
  Real moment_scale(const StepReport& step, Real amplitude);

  ImplicitIteration& iteration_;
  const Motion& motion_;
  std::unique_ptr<Treatment> treatment_;
  Vec3 axis_point_;
  Real time_step_;
  Real weights_step_;  // fitted to the frequency
  Load initial_;
  DualTimeState state_;
  std::vector<Conserved<Real>> old_, older_;  // [owned_cells] U^n, U^(n-1), momenta along axes at rest
};

}  // namespace alphadot
