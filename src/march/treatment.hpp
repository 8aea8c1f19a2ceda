// How the motion of the body enters the equations: by a field velocity or by a moving grid.
#pragma once

#include <cmath>
#include <memory>
#include <optional>
#include <span>
#include <utility>

#include "march/gust_field.hpp"
#include "march/time_levels.hpp"
#include "space/conditions.hpp"
#include "space/discretization.hpp"
#include "space/forces.hpp"

namespace alphadot {

/// What the time march asks of a treatment. Everything is a function of the number of the time level, or of a
/// state that checkpoints hold: a restarted march finds the same.
class Treatment {
 public:
  Treatment(const Motion& motion, const Vec3& axis_point, Real time_step)
      : motion_(motion), axis_point_(axis_point), time_step_(time_step) {}
  virtual ~Treatment() = default;

  /// Brings the grid to time level `step` and tells what drives the flow there.
  virtual Conditions<Real> move_to(int step) = 0;
  /// Of the body at a time level; at 0 before anything jumps.
  virtual Attitude attitude(int step) const { return motion_.at(step > 0 ? step * time_step_ : -1); }
  /// The flow is solved along axes turned by this rotation vector.
  virtual Vec3 axes(const Attitude& attitude) const = 0;
  /// [owned_cells] volumes at the level of the latest move_to(), and one and two levels before.
  virtual std::span<const Real> volumes(int levels_back) const = 0;
  /// A load along the axes of the solution about `center` at rest, turned into one on body axes about the
  /// same point of the body at the latest level.
  virtual Load on_body(const Load& load, const Vec3& center) const = 0;
  /// Lets a body whose motion is not given answer the load on it at the latest level (body axes, about the
  /// moment centre): what then drives the flow. Nothing where the motion is given.
  virtual std::optional<Conditions<Real>> answer(const Load&) { return std::nullopt; }
  /// How much a change of load is to the motion: of the moment that answers it.
  virtual Real size_of(const Load& change) const { return std::abs(change.moment[motion_.moment_axis()]); }

 protected:
  const Motion& motion_;
  Vec3 axis_point_;
  Real time_step_;
};

/// The treatment that a case asks for; a gust only meets a field velocity. `domain` and `discretization` are
/// moved by all but the field velocity.
std::unique_ptr<Treatment> make_treatment(TreatmentKind kind, const Motion& motion, const Vec3& axis_point,
                                          Real time_step, Subdomain& domain, Discretization& discretization,
                                          const Communicator& comm,
                                          std::unique_ptr<GustField> gust = nullptr);

/// Still grid, body axes: the motion is a velocity in the fluxes (the paper's section II), and so is a gust.
/// The axes turn with the body; instead of a source, the old time levels are turned onto them.
class FieldVelocity : public Treatment {
 public:
  FieldVelocity(const Motion& motion, const Vec3& axis_point, Real time_step,
                const Discretization& discretization, std::unique_ptr<GustField> gust = nullptr)
      : Treatment(motion, axis_point, time_step), discretization_(discretization), gust_(std::move(gust)) {}

  Conditions<Real> move_to(int step) override { return conditions_of(attitude(step), {}, step * time_step_); }
  Vec3 axes(const Attitude& attitude) const override { return attitude.angle; }
  std::span<const Real> volumes(int) const override { return discretization_.domain().volume; }
  Load on_body(const Load& load, const Vec3&) const override { return load; }

 protected:
  /// At a time, of a body that has gone `travel`.
  Conditions<Real> conditions_of(const Attitude& attitude, const Vec3& travel, Real time) {
    auto out = field_velocity_conditions(attitude, motion_.wind(), axis_point_, discretization_.gamma());
    out.turning_source = false;
    if (gust_) gust_->enter(out, attitude, travel, motion_.wind().x, time);
    return out;
  }

 private:
  const Discretization& discretization_;
  std::unique_ptr<GustField> gust_;
};

}  // namespace alphadot
