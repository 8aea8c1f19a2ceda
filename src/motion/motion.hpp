// Prescribed motions: attitude, rates and field velocity as functions of time.
#pragma once

#include "core/flight.hpp"
#include "core/vec3.hpp"
#include "motion/motion_table.hpp"
#include "motion/rigid_motion.hpp"
#include "motion/settings.hpp"

namespace alphadot {

/// Where the body is and how it moves at one moment. Angles in rad, vectors in the mesh axes of the body at
/// rest (x aft, y starboard, z up), velocities in units of the free-stream sound speed.
struct Attitude {
  Real alpha = 0, beta = 0;  ///< incidence of the relative wind at the axis point, in body axes
  Vec3 angle;                ///< rotation vector from rest: +y nose up, +z nose to port, +x starboard wing up
  Vec3 rotation;             ///< angular velocity, see angular_velocity()
  Vec3 velocity;             ///< of the axis point
};

/// Whether a motion is a sine of its reduced frequency.
bool is_harmonic(MotionKind kind);

/// A motion of the whole body about a mean incidence. Time is non-dimensional: t = t_phys a_inf / (unit of
/// length). The body is at rest before t = 0; what jumps there has jumped at t = 0.
///
/// | kind       | moves                                                                                 |
/// |------------|---------------------------------------------------------------------------------------|
/// | plunge     | alpha = alpha0 + A sin(k t*) by translation along z, the axial speed kept (paper, (4)) |
/// | sway       | beta = beta0 + A sin(k t*) by translation along y, likewise                           |
/// | pitch      | turn A sin(k t*) about y through the axis point, which flies straight on               |
/// | yaw        | the same about z, nose to port first (beta grows)                                     |
/// | roll       | the same about x, starboard wing down first                                           |
/// | flap       | pitch, and the flight path turns with the body: alpha stays                           |
/// | step_alpha | alpha0 + A from t = 0 on by translation (paper, section III)                          |
/// | ramp_alpha | alpha from alpha0 to alpha0 + A over the duration, at a constant rate                 |
/// | step_q     | flap at the constant reduced pitch rate A from t = 0 on                               |
/// | table      | alpha, theta and position from a table; given alpha, the axial speed is kept          |
/// | free       | nothing here: the body stays at its release (rigid_body.hpp)                          |
class Motion {
 public:
  /// `mach` and the incidence set the free stream; `length` the scale of reduced frequency and t* = 2 V t /
  /// length; `duration` (t*) is that of a ramp, `table` that of kind table.
  Motion(const MotionSettings& settings, const FreestreamSettings& stream, Real length, Real duration = 0,
         MotionTable table = {});

  Attitude at(Real time) const;
  /// Velocity of the undisturbed air in mesh axes at rest.
  Vec3 wind() const { return wind_; }
  /// Rotation of the axes in steady flight, rad per unit of time: settings.rotation = (p*, q*, r*) in mesh
  /// axes.
  Vec3 steady_rotation() const;
  bool is_harmonic() const { return alphadot::is_harmonic(settings_.kind); }
  /// True when velocity or rotation at t = 0 differ from those at rest.
  bool starts_with_jump() const;
  Real period() const;  ///< of a harmonic motion
  /// The angle that a motion drives, as deviation from its mean, in rad.
  Real driven_angle(const Attitude& attitude) const;
  /// Largest driven angle, or 0 when it is not a measure of the loads.
  Real driven_amplitude() const;
  /// Axis (0 x, 1 y, 2 z) about which the moment answers the motion.
  int moment_axis() const;
  Real omega() const { return 2 * speed_ * settings_.reduced_frequency / length_; }
  /// t* = 2 V t / length of a time, and back.
  Real reduced_time(Real time) const { return 2 * speed_ * time / length_; }
  Real time_of(Real reduced_time) const { return reduced_time * length_ / (2 * speed_); }

 private:
  /// Changes alpha by translation along z, the axial speed kept (paper, equation (4)).
  void sink(Attitude& attitude, Real change) const;
  /// Makes the flight path turn with the body, so that the wind on its axes stays.
  void hold_wind(Attitude& attitude) const;
  void follow_table(Attitude& attitude, Real time) const;

  MotionSettings settings_;
  Real speed_, length_, alpha_, beta_, amplitude_;
  Real duration_;  // of a ramp, in time
  MotionTable table_;
  Vec3 wind_;
};

/// Velocity of the air that an incidence gives: V (cos a cos b, -sin b, sin a cos b) along (aft, starboard,
/// up). beta is positive with the wind from starboard.
Vec3 wind_velocity(Real speed, Real alpha, Real beta);

/// The vector `v` along axes that have been turned by the rotation vector `angle` (Rodrigues): components on
/// body axes.
Vec3 on_turned_axes(const Vec3& v, const Vec3& angle);

/// Sets the incidence that follows from velocity and angle, in air that moves with `wind`.
void find_incidence(Attitude& attitude, const Vec3& wind);

/// Angular velocity, along the axes at rest, of axes turned by the rotation vector `angle` (rad) that changes
/// at `rate` (rad per unit of time): the rate itself only while that turns about the same axis (inverse of
/// Bortz's equation, 1971).
Vec3 angular_velocity(const Vec3& angle, const Vec3& rate);

}  // namespace alphadot
