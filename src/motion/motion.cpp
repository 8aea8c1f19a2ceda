#include "motion/motion.hpp"

#include <cmath>

namespace alphadot {

Vec3 wind_velocity(Real speed, Real alpha, Real beta) {
  return speed * Vec3{std::cos(alpha) * std::cos(beta), -std::sin(beta), std::sin(alpha) * std::cos(beta)};
}

Vec3 on_turned_axes(const Vec3& v, const Vec3& angle) {
  const Real turn = norm(angle);
  if (turn == 0) return v;
  const Vec3 axis = (1 / turn) * angle;
  const Real c = std::cos(turn), s = std::sin(turn);
  return c * v - s * cross(axis, v) + (1 - c) * dot(axis, v) * axis;
}

Motion::Motion(const MotionSettings& settings, const FreestreamSettings& stream, Real length)
    : settings_(settings),
      speed_(stream.mach),
      length_(length),
      alpha_(stream.alpha * radians_per_degree),
      beta_(stream.beta * radians_per_degree),
      wind_(wind_velocity(speed_, alpha_, beta_)) {}

Real Motion::period() const {
  return 2 * pi / omega();
}

Real Motion::driven_angle(const Attitude& attitude) const {
  switch (settings_.kind) {
    case MotionKind::sway:
    case MotionKind::yaw:
      return attitude.beta - beta_;
    case MotionKind::roll:
      return attitude.angle.x;
    case MotionKind::flap:
      return attitude.angle.y;
    default:
      return attitude.alpha - alpha_;
  }
}

int Motion::moment_axis() const {
  switch (settings_.kind) {
    case MotionKind::sway:
    case MotionKind::yaw:
      return 2;
    case MotionKind::roll:
      return 0;
    default:
      return 1;
  }
}

Attitude Motion::at(Real time) const {
  Attitude out{.alpha = alpha_, .beta = beta_, .angle = {}, .rotation = {}, .velocity = {}};
  const Real phase = omega() * time;
  const Real amplitude = settings_.amplitude * radians_per_degree;
  const Real angle = amplitude * std::sin(phase), rate = amplitude * omega() * std::cos(phase);
  switch (settings_.kind) {
    case MotionKind::plunge:
      // Paper, equation (4): the air gains w' along z, that is the body sinks at w'; the x velocity stays.
      out.alpha += angle;
      out.velocity.z = -speed_ * std::cos(beta_) * std::sin(angle) / std::cos(alpha_ + angle);
      break;
    case MotionKind::sway:
      out.beta += angle;
      out.velocity.y = speed_ * std::sin(angle) / std::cos(beta_ + angle);
      break;
    case MotionKind::pitch:
      out.alpha += angle;
      out.angle.y = angle;
      out.rotation.y = rate;
      break;
    default:
      break;
  }
  return out;
}

}  // namespace alphadot
