// Prescribed motions: attitude, rates and field velocity as functions of time.
#pragma once

#include "core/case.hpp"
#include "core/vec3.hpp"
#include "motion/rigid_motion.hpp"

namespace alphadot {

/// Where the body is and how it moves at one moment. Angles in rad, vectors in the mesh axes of the body at
/// rest (x aft, y starboard, z up), velocities in units of the free-stream sound speed.
struct Attitude {
  Real alpha = 0, beta = 0;  ///< incidence of the relative wind at the axis point, in body axes
  Vec3 angle;                ///< rotation vector from rest: +y nose up, +z nose to port, +x starboard wing up
  Vec3 rotation;             ///< its rate
  Vec3 velocity;             ///< of the axis point
};

/// A motion of the whole body about a mean incidence. Time is non-dimensional: t = t_phys a_inf / (unit of
/// length).
class Motion {
 public:
  /// `mach` and the incidence set the free stream; `length` the scale of reduced frequency and t* = 2 V t /
  /// length.
  Motion(const MotionSettings& settings, const FreestreamSettings& stream, Real length);

  Attitude at(Real time) const;
  /// Velocity of the undisturbed air in mesh axes at rest.
  Vec3 wind() const { return wind_; }
  Real period() const;  ///< of a harmonic motion
  /// The angle that a harmonic motion drives, as deviation from its mean, in rad.
  Real driven_angle(const Attitude& attitude) const;
  /// Axis (0 x, 1 y, 2 z) about which the moment answers the motion.
  int moment_axis() const;
  Real omega() const { return 2 * speed_ * settings_.reduced_frequency / length_; }
  /// t* = 2 V t / length of a time, and back.
  Real reduced_time(Real time) const { return 2 * speed_ * time / length_; }
  Real time_of(Real reduced_time) const { return reduced_time * length_ / (2 * speed_); }

 private:
  MotionSettings settings_;
  Real speed_, length_, alpha_, beta_;
  Vec3 wind_;
};

/// Velocity of the air that an incidence gives: V (cos a cos b, -sin b, sin a cos b) along (aft, starboard,
/// up). beta is positive with the wind from starboard.
Vec3 wind_velocity(Real speed, Real alpha, Real beta);

/// The vector `v` along axes that have been turned by the rotation vector `angle` (Rodrigues): components on
/// body axes.
Vec3 on_turned_axes(const Vec3& v, const Vec3& angle);

}  // namespace alphadot
