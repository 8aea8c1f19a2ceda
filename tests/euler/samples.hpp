// Random gas states, directions and rotations for property tests. The same numbers on every platform.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>

#include "euler/flux.hpp"

namespace alphadot::testing_support {

inline constexpr Real gamma_air = 1.4;
inline constexpr FluxKind all_fluxes[] = {FluxKind::roe, FluxKind::van_leer, FluxKind::hllc};

inline std::string name_of(FluxKind kind) {
  return kind == FluxKind::roe ? "roe" : kind == FluxKind::hllc ? "hllc" : "van_leer";
}

class Samples {
 public:
  explicit Samples(std::uint32_t seed) : generator_(seed) {}

  Real between(Real lower, Real upper) {
    return lower + (upper - lower) * (static_cast<Real>(generator_()) / 4294967295.0);
  }
  Vec3 vector(Real size) { return {between(-size, size), between(-size, size), between(-size, size)}; }
  Vec3 direction() {
    for (;;) {
      const Vec3 v = vector(1);
      const Real length = norm(v);
      if (length > 0.1 && length <= 1) return (1 / length) * v;
    }
  }
  /// Density and pressure within a factor `spread` of 1 either way, each velocity component below `speed`.
  Primitive<Real> state(Real spread = 10, Real speed = 3) {
    const Real range = std::log(spread);
    const Vec3 u = vector(speed);
    return {{std::exp(between(-range, range)), u.x, u.y, u.z, std::exp(between(-range, range))}};
  }

 private:
  std::mt19937 generator_;
};

/// `v` turned about `axis` (a unit vector) by `angle`, right-handed (Rodrigues).
inline Vec3 turned(const Vec3& v, const Vec3& axis, Real angle) {
  return std::cos(angle) * v + std::sin(angle) * cross(axis, v) + (1 - std::cos(angle)) * dot(axis, v) * axis;
}

inline Vec3 momentum(const Conserved<Real>& u) {
  return {u[1], u[2], u[3]};
}

inline Primitive<Real> with_velocity(Primitive<Real> w, const Vec3& u) {
  for (int i = 0; i < 3; ++i) w[i + 1] = u[i];
  return w;
}

/// Largest entry of both: the scale of round-off in a flux between two states.
inline Real largest(const Five<Real>& a, const Five<Real>& b = {}) {
  Real out = 0;
  for (int i = 0; i < 5; ++i) out = std::max({out, std::abs(a[i]), std::abs(b[i])});
  return out;
}

/// Largest difference of the entries.
inline Real distance(const Five<Real>& a, const Five<Real>& b) {
  return largest(a - b);
}

inline void expect_near(const Five<Real>& found, const Five<Real>& expected, Real tolerance) {
  for (int i = 0; i < 5; ++i) EXPECT_NEAR(found[i], expected[i], tolerance) << "entry " << i;
}

}  // namespace alphadot::testing_support
