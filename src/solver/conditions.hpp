// What drives the flow at one moment: the free stream and the motion of the grid through it.
#pragma once

#include "euler/state.hpp"
#include "motion/motion.hpp"
#include "motion/rigid_motion.hpp"

namespace alphadot {

/// Free stream and grid velocity along the axes in which the flow is solved. On rotating body axes the
/// velocity stays absolute and only its components turn: the momentum balance gains -rho rotation x u in
/// every cell.
template <class T>
struct Conditions {
  Primitive<T> free_stream;
  GridMotion<T> grid;
};

/// Conditions of the field velocity approach: a still mesh, everything along body axes.
inline Conditions<Real> field_velocity_conditions(const Attitude& attitude, const Vec3& wind,
                                                  const Vec3& axis_point, Real gamma) {
  return {free_stream(on_turned_axes(wind, attitude.angle), gamma),
          {on_turned_axes(attitude.velocity, attitude.angle),
           on_turned_axes(attitude.rotation, attitude.angle), axis_point}};
}

}  // namespace alphadot
