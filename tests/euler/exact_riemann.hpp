// The exact solution of the Riemann problem of a perfect gas in one dimension, for tests.
//
// E. F. Toro, Riemann Solvers and Numerical Methods for Fluid Dynamics, 3rd edition, Springer 2009,
// chapter 4.
#pragma once

#include <cmath>
#include <stdexcept>

#include "core/types.hpp"

namespace alphadot::testing_support {

/// Density, velocity and pressure on a line.
struct GasOnLine {
  Real rho, u, p;
};

class ExactRiemann {
 public:
  /// Throws std::domain_error when the two sides separate and leave a vacuum (equation 4.40).
  ExactRiemann(const GasOnLine& left, const GasOnLine& right, Real gamma)
      : left_(left), right_(right), gamma_(gamma) {
    if (2 / (gamma - 1) * (sound_speed(left) + sound_speed(right)) <= right.u - left.u)
      throw std::domain_error("vacuum");
    // Newton's method on (4.5) in log p: stays positive; the function is monotonic and concave.
    Real p = 0.5 * (left.p + right.p);
    for (int iteration = 0; iteration < 100; ++iteration) {
      const Wave l = wave(left, p), r = wave(right, p);
      const Real step = -(l.jump + r.jump + right.u - left.u) / (p * (l.slope + r.slope));
      p *= std::exp(std::fmax(-3.0, std::fmin(3.0, step)));
      if (std::fabs(step) < 1e-15) break;
    }
    pressure_ = p;
    velocity_ = 0.5 * (left.u + right.u + wave(right, p).jump - wave(left, p).jump);  // (4.9)
  }

  Real star_pressure() const { return pressure_; }
  Real star_velocity() const { return velocity_; }

  /// State on the ray x / t = `speed` (section 4.5). The contact itself belongs to the left.
  GasOnLine at(Real speed) const {
    if (speed <= velocity_) return behind_left_wave(left_, velocity_, speed);
    const GasOnLine mirrored =
        behind_left_wave({right_.rho, -right_.u, right_.p}, -velocity_, -speed);  // reflection of the line
    return {mirrored.rho, -mirrored.u, mirrored.p};
  }

 private:
  struct Wave {
    Real jump, slope;
  };

  Real sound_speed(const GasOnLine& w) const { return std::sqrt(gamma_ * w.p / w.rho); }

  /// Change of speed across a wave that brings the side to pressure p, and its derivative: (4.6), (4.7),
  /// (4.37).
  Wave wave(const GasOnLine& side, Real p) const {
    if (p > side.p) {
      const Real a = 2 / ((gamma_ + 1) * side.rho), b = (gamma_ - 1) / (gamma_ + 1) * side.p;
      const Real root = std::sqrt(a / (p + b));
      return {(p - side.p) * root, root * (1 - 0.5 * (p - side.p) / (b + p))};
    }
    const Real a = sound_speed(side), z = (gamma_ - 1) / (2 * gamma_);
    return {2 * a / (gamma_ - 1) * (std::pow(p / side.p, z) - 1),
            std::pow(p / side.p, -(gamma_ + 1) / (2 * gamma_)) / (side.rho * a)};
  }

  /// Left of the contact, which moves at `contact`: (4.50)-(4.56).
  GasOnLine behind_left_wave(const GasOnLine& w, Real contact, Real speed) const {
    const Real a = sound_speed(w), g = gamma_, ratio = pressure_ / w.p;
    if (ratio > 1) {
      const Real shock = w.u - a * std::sqrt((g + 1) / (2 * g) * ratio + (g - 1) / (2 * g));
      if (speed <= shock) return w;
      const Real k = (g - 1) / (g + 1);
      return {w.rho * (ratio + k) / (k * ratio + 1), contact, pressure_};
    }
    const Real star_sound = a * std::pow(ratio, (g - 1) / (2 * g));
    if (speed <= w.u - a) return w;
    if (speed >= contact - star_sound) return {w.rho * std::pow(ratio, 1 / g), contact, pressure_};
    const Real sound = 2 / (g + 1) * (a + (g - 1) / 2 * (w.u - speed));  // within the fan
    return {w.rho * std::pow(sound / a, 2 / (g - 1)), speed + sound,
            w.p * std::pow(sound / a, 2 * g / (g - 1))};
  }

  GasOnLine left_, right_;
  Real gamma_, pressure_, velocity_;
};

}  // namespace alphadot::testing_support
