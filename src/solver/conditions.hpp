// What drives the flow at one moment: the free stream and the motion of the grid through it.
#pragma once

#include "euler/state.hpp"
#include "motion/motion.hpp"
#include "motion/rigid_motion.hpp"

namespace alphadot {

/// Free stream and grid velocity along the axes in which the flow is solved. On rotating body axes the
/// velocity stays absolute and only its components turn: the momentum balance gains -rho rotation x (u -
/// turning_stream) in every cell. The turning stream is zero where the free stream keeps its direction in
/// space (forced pitch: its components turn), and the free-stream velocity where the flight path turns with
/// the body (steady rotation at constant incidence): what must stay at rest far away is the air, not its
/// components.
template <class T>
struct Conditions {
  Primitive<T> free_stream;
  GridMotion<T> grid;
  Vec3Of<T> turning_stream{};
};

/// Conditions of the field velocity approach: a still mesh, everything along body axes.
inline Conditions<Real> field_velocity_conditions(const Attitude& attitude, const Vec3& wind,
                                                  const Vec3& axis_point, Real gamma) {
  return {free_stream(on_turned_axes(wind, attitude.angle), gamma),
          {on_turned_axes(attitude.velocity, attitude.angle),
           on_turned_axes(attitude.rotation, attitude.angle), axis_point},
          {}};
}

/// Conditions of steady flight at fixed incidence: nothing moves, and a rotation would turn the stream too.
inline Conditions<Real> steady_conditions(const Vec3& wind, const Vec3& axis_point, Real gamma) {
  return {free_stream(wind, gamma), {{}, {}, axis_point}, wind};
}

}  // namespace alphadot
