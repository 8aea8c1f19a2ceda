// How the motion of the body enters the equations: by a field velocity or by a moving grid.
#pragma once

#include <memory>
#include <span>

#include "march/time_levels.hpp"
#include "space/conditions.hpp"
#include "space/discretization.hpp"
#include "space/forces.hpp"

namespace alphadot {

/// What the time march asks of a treatment. Everything is a function of the number of the time level: a
/// restarted march finds the same.
class Treatment {
 public:
  virtual ~Treatment() = default;

  /// Brings the grid to time level `step` and tells what drives the flow there.
  virtual Conditions<Real> move_to(int step) = 0;
  /// The flow is solved along axes turned by this rotation vector.
  virtual Vec3 axes(const Attitude& attitude) const = 0;
  /// [owned_cells] volumes at the level of the latest move_to(), and one and two levels before.
  virtual std::span<const Real> volumes(int levels_back) const = 0;
  /// A load along the axes of the solution about `center` at rest, turned into one on body axes about the
  /// same point of the body at the latest level.
  virtual Load on_body(const Load& load, const Vec3& center) const = 0;
};

/// The treatment that a case asks for. `domain` and `discretization` are moved by all but the field velocity.
std::unique_ptr<Treatment> make_treatment(TreatmentKind kind, const Motion& motion, const Vec3& axis_point,
                                          Real time_step, Subdomain& domain, Discretization& discretization,
                                          const Communicator& comm);

/// Still grid, body axes: the motion is a velocity in the fluxes (the paper's section II). The axes turn with
/// the body; instead of a source, the old time levels are turned onto them.
class FieldVelocity final : public Treatment {
 public:
  FieldVelocity(const Motion& motion, const Vec3& axis_point, Real time_step,
                const Discretization& discretization)
      : motion_(motion), axis_point_(axis_point), time_step_(time_step), discretization_(discretization) {}

  Conditions<Real> move_to(int step) override {
    auto out = field_velocity_conditions(motion_.at(step * time_step_), motion_.wind(), axis_point_,
                                         discretization_.gamma());
    out.turning_source = false;
    return out;
  }
  Vec3 axes(const Attitude& attitude) const override { return attitude.angle; }
  std::span<const Real> volumes(int) const override { return discretization_.domain().volume; }
  Load on_body(const Load& load, const Vec3&) const override { return load; }

 private:
  const Motion& motion_;
  Vec3 axis_point_;
  Real time_step_;
  const Discretization& discretization_;
};

}  // namespace alphadot
