// A body that flies freely: its motion is solved with the flow.
#pragma once

#include <memory>
#include <vector>

#include "march/gust_field.hpp"
#include "march/treatment.hpp"
#include "motion/rigid_body.hpp"

namespace alphadot {

/// By field velocity: the mesh stands still. In every inner iteration the body answers the loads on it by the
/// trapezoidal rule of rigid_body.hpp from the latest time step on; the state is a function of what the loads
/// of all steps were, and is kept in checkpoints.
class FreeFlight final : public FieldVelocity {
 public:
  /// A body released with `motion`'s steady rotation; its centre of gravity is the axis point. `initial`:
  /// load at the release, along body axes about `moment_center`, as all that it answers. `half_model`: the
  /// mirror image bears the same.
  FreeFlight(const RigidBody& body, const Motion& motion, const Vec3& axis_point, Real time_step,
             const Discretization& discretization, std::unique_ptr<GustField> gust, const Vec3& moment_center,
             bool half_model, const Load& initial);

  Conditions<Real> move_to(int step) override;
  /// Of the latest level.
  Attitude attitude(int) const override;
  std::optional<Conditions<Real>> answer(const Load& load) override;
  /// Change of speed per time, of the axis point and of a point a unit away from it.
  Real size_of(const Load& change) const override;

  const RigidBody& body() const { return body_; }
  const RigidBodyState& state() const { return now_; }
  /// For checkpoints: all that the next step needs.
  std::vector<Real> numbers() const;
  void restore(const std::vector<Real>& numbers);

 private:
  /// Along axes at rest about the centre of gravity, of the whole body.
  BodyLoad at_rest(const Load& load) const;
  /// Along body axes.
  Load whole(const Load& load) const;
  Conditions<Real> conditions_now();

  RigidBody body_;
  Vec3 moment_center_;
  bool half_model_;
  Real time_ = 0;                // of the latest level
  RigidBodyState before_, now_;  // at the level before and at the latest one
  BodyLoad load_before_, load_;
};

}  // namespace alphadot
