#include "motion/motion.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

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

Vec3 angular_velocity(const Vec3& angle, const Vec3& rate) {
  constexpr Real small = 0.01;  // below, the series to its third term
  const Real turn2 = dot(angle, angle), turn = std::sqrt(turn2);
  const bool is_small = turn < small;
  const Real half = std::sin(turn / 2);
  const Real first = is_small ? 0.5 - turn2 / 24 + turn2 * turn2 / 720 : 2 * half * half / turn2;
  const Real second =
      is_small ? 1.0 / 6 - turn2 / 120 + turn2 * turn2 / 5040 : (turn - std::sin(turn)) / (turn * turn2);
  const Vec3 across = cross(angle, rate);
  return rate + first * across + second * cross(angle, across);
}

namespace {

void turn(Attitude& attitude, int axis, Real angle, Real rate) {
  Vec3 rates;
  rates[axis] = rate;
  attitude.angle[axis] = angle;
  attitude.rotation = angular_velocity(attitude.angle, rates);
}

}  // namespace

Motion::Motion(const MotionSettings& settings, const FreestreamSettings& stream, Real length, Real duration,
               MotionTable table)
    : settings_(settings),
      speed_(stream.mach),
      length_(length),
      alpha_(stream.alpha * radians_per_degree),
      beta_(stream.beta * radians_per_degree),
      amplitude_(settings.kind == MotionKind::step_q ? settings.amplitude * 2 * speed_ / length
                                                     : settings.amplitude * radians_per_degree),
      duration_(time_of(duration)),
      table_(std::move(table)),
      wind_(wind_velocity(speed_, alpha_, beta_)) {}

Real Motion::period() const {
  return 2 * pi / omega();
}

bool is_harmonic(MotionKind kind) {
  switch (kind) {
    case MotionKind::plunge:
    case MotionKind::sway:
    case MotionKind::pitch:
    case MotionKind::yaw:
    case MotionKind::roll:
    case MotionKind::flap:
      return true;
    default:
      return false;
  }
}

bool Motion::starts_with_jump() const {
  const Attitude start = at(0);
  return norm(start.velocity) + norm(start.rotation) > 0;
}

Vec3 Motion::steady_rotation() const {
  const Vec3& reduced = settings_.rotation;
  return 2 * speed_ / length_ * Vec3{-reduced.x, reduced.y, -reduced.z};
}

Real Motion::driven_angle(const Attitude& attitude) const {
  switch (settings_.kind) {
    case MotionKind::sway:
    case MotionKind::yaw:
      return attitude.beta - beta_;
    case MotionKind::roll:
      return -attitude.angle.x;
    case MotionKind::flap:
      return attitude.angle.y;
    default:
      return attitude.alpha - alpha_;
  }
}

Real Motion::driven_amplitude() const {
  return is_harmonic() || settings_.kind == MotionKind::step_alpha || settings_.kind == MotionKind::ramp_alpha
             ? amplitude_
             : 0;
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

void Motion::sink(Attitude& attitude, Real change) const {
  // The air gains w' along z, that is the body sinks at w'; the x velocity stays.
  attitude.alpha += change;
  attitude.velocity.z = -speed_ * std::cos(beta_) * std::sin(change) / std::cos(attitude.alpha);
  // The speed in the plane of symmetry changes, and with it what the lateral speed means as an angle.
  if (beta_ != 0 && change != 0)
    attitude.beta =
        std::atan2(std::sin(beta_), std::cos(beta_) * std::cos(alpha_) / std::cos(attitude.alpha));
}

void Motion::hold_wind(Attitude& attitude) const {
  attitude.velocity = wind_ - on_turned_axes(wind_, -attitude.angle);
}

void find_incidence(Attitude& attitude, const Vec3& wind) {
  const Vec3 air = on_turned_axes(wind - attitude.velocity, attitude.angle);
  attitude.alpha = std::atan2(air.z, air.x);
  attitude.beta = std::atan2(-air.y, std::hypot(air.x, air.z));
}

void Motion::follow_table(Attitude& attitude, Real time) const {
  const Real t = reduced_time(time), per_time = 2 * speed_ / length_;
  if (table_.theta) turn(attitude, 1, table_.theta->value(t), per_time * table_.theta->rate(t));
  if (table_.alpha) {
    // On the turned axes the wind keeps its axial and lateral components.
    attitude.alpha = table_.alpha->value(t);
    const Vec3 air{wind_.x, wind_.y, wind_.x * std::tan(attitude.alpha)};
    attitude.velocity = wind_ - on_turned_axes(air, -attitude.angle);
    return;
  }
  for (int axis = 0; axis < 3; ++axis)
    if (const auto& curve = table_.position[axis]) attitude.velocity[axis] = per_time * curve->rate(t);
  find_incidence(attitude, wind_);
}

Attitude Motion::at(Real time) const {
  Attitude out{.alpha = alpha_, .beta = beta_, .angle = {}, .rotation = {}, .velocity = {}};
  if (time < 0) return out;
  const Real phase = omega() * time;
  const Real angle = amplitude_ * std::sin(phase), rate = amplitude_ * omega() * std::cos(phase);
  switch (settings_.kind) {
    case MotionKind::none:
    case MotionKind::free:
      break;
    case MotionKind::plunge:
      sink(out, angle);
      break;
    case MotionKind::sway:
      out.beta += angle;
      out.velocity.y = speed_ * std::sin(angle) / std::cos(beta_ + angle);
      break;
    case MotionKind::pitch:
      turn(out, 1, angle, rate);
      out.alpha += angle;
      break;
    case MotionKind::yaw:
      turn(out, 2, angle, rate);
      find_incidence(out, wind_);
      break;
    case MotionKind::roll:
      turn(out, 0, -angle, -rate);
      find_incidence(out, wind_);
      break;
    case MotionKind::flap:
      turn(out, 1, angle, rate);
      hold_wind(out);
      break;
    case MotionKind::step_alpha:
      sink(out, amplitude_);
      break;
    case MotionKind::ramp_alpha:
      sink(out, amplitude_ * std::min(time / duration_, Real{1}));
      break;
    case MotionKind::step_q:
      turn(out, 1, amplitude_ * time, amplitude_);
      hold_wind(out);
      break;
    case MotionKind::table:
      follow_table(out, time);
      break;
  }
  return out;
}

}  // namespace alphadot
