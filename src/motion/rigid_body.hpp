// A rigid body under loads: Newton's and Euler's equations over one time step.
#pragma once

#include <array>

#include "core/symmetric3.hpp"
#include "core/vec3.hpp"
#include "motion/quaternion.hpp"
#include "motion/settings.hpp"

namespace alphadot {

/// Where a body is and how it moves. Axes at rest are those of the mesh at the release.
struct RigidBodyState {
  Vec3 position, velocity;  ///< of the centre of gravity from its release, along axes at rest
  Quaternion attitude;
  Vec3 rotation;  ///< angular velocity along body axes
  Real work = 0;  ///< that all loads, gravity too, have done on the body since the release

  bool operator==(const RigidBodyState&) const = default;
};

/// Force, and moment about the centre of gravity, along axes at rest.
struct BodyLoad {
  Vec3 force, moment;
};

/// Mass, inertia and what the body may do. Any units that belong together.
class RigidBody {
 public:
  struct Properties {
    Real mass = 0;
    Symmetric3 inertia{};                  ///< tensor about the centre of gravity, along body axes
    Vec3 gravity;                          ///< acceleration along axes at rest
    std::array<bool, 3> moves{}, turns{};  ///< free along axes at rest, free about body axes; else held
  };

  /// Throws std::logic_error when has_inertia() does not hold, or there is no mass to what may move.
  explicit RigidBody(const Properties& properties);

  /// The state after a time step in which `mean` is the mean of the loads at its ends:
  ///   m (v1 - v0) = dt (F + m g),                   x1 - x0 = dt (v0 + v1) / 2,
  ///   J W1 = R(T)^T (J W0 + dt R0^T M),             T = dt (W0 + W1) / 2,
  /// with angular velocities W along body axes and the rotation R(T) from the old axes to the new ones; along
  /// held axes nothing moves. Of second order; momentum and angular momentum change by the loads' impulse,
  /// and kinetic energy by their work F . (x1 - x0) + M . R0 T, to round-off, at any step (as J. C. Simo & K.
  /// K. Wong, Int. J. Numer. Meth. Eng. 31, 1991, 19). Throws DivergedError when the step is too long for it.
  RigidBodyState advance(const RigidBodyState& from, const BodyLoad& mean, Real time_step) const;

  Real kinetic_energy(const RigidBodyState& state) const;
  /// About the centre of gravity, along axes at rest.
  Vec3 angular_momentum(const RigidBodyState& state) const;
  /// Acceleration of a body that does not turn, and angular acceleration along its axes, by a load along
  /// them.
  Vec3 acceleration(const Vec3& force) const;
  Vec3 angular_acceleration(const Vec3& moment) const;

 private:
  Properties properties_;
  Symmetric3 inverse_;  // of the inertia of what may turn
};

/// Whether the tensor of what may turn is positive definite, and is that of a mass: no moment of inertia is
/// larger than the sum of the others, where all are of what may turn.
bool has_inertia(const RigidBody::Properties& properties);

/// Of a case, in solver units: density rho_inf, speed a_inf, the unit of `length`.
RigidBody::Properties properties_of(const BodySettings& body, Real length, Real speed);

}  // namespace alphadot
