// A frame that moves as a rigid body: what the mesh does, or seems to do, at one moment.
#pragma once

#include "core/vec3.hpp"

namespace alphadot {

/// Velocity field of the grid, v_g(x) = velocity + rotation x (x - axis). With a field velocity the mesh
/// stays where it is and only this enters the fluxes; with a moving mesh it is the speed of its points.
template <class T>
struct GridMotion {
  Vec3Of<T> velocity;  ///< of the point `axis`
  Vec3Of<T> rotation;  ///< rad per unit time
  Vec3 axis;

  Vec3Of<T> at(const Vec3& x) const { return velocity + cross(rotation, x - axis); }
  /// Speed along a unit normal at x.
  T normal_speed(const Vec3& x, const Vec3& normal) const { return dot(at(x), normal); }
};

}  // namespace alphadot
