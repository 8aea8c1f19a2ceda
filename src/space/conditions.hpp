// What drives the flow at one moment: the free stream and the motion of the grid through it.
#pragma once

#include <vector>

#include "core/types.hpp"
#include "euler/state.hpp"
#include "motion/motion.hpp"
#include "motion/rigid_motion.hpp"

namespace alphadot {

/// Speeds of faces along their unit normals, for a grid that does not move as a rigid body.
struct FaceSpeeds {
  std::vector<Real> interior;  ///< [faces]
  std::vector<Real> boundary;  ///< [boundary_faces]
};

/// A field velocity g that varies in space: air that moves across the stream, g = strength * direction, in
/// fronts with the unit normal `front`. Its sums over the faces of each cell, [owned_cells].
struct GustInCells {
  Vec3 front, direction;
  std::vector<Real> slope;       ///< volume times d strength / d(front . x)
  std::vector<Real> divergence;  ///< what g's flow out of the cell lacks to zero by the faces' finite number
};

/// Free stream and grid velocity along the axes in which the flow is solved. On rotating body axes the
/// velocity stays absolute and only its components turn: the momentum balance gains -rho rotation x (u -
/// turning_stream) in every cell, and the energy balance the work of that. The turning stream is zero where
/// the free stream keeps its direction in space (forced pitch: its components turn), and the free-stream
/// velocity where the flight path turns with the body (steady rotation at constant incidence): what must stay
/// at rest far away is the air, not its components.
template <class T>
struct Conditions {
  Primitive<T> free_stream;
  GridMotion<T> grid;
  Vec3Of<T> turning_stream{};
  /// False where the axes do not turn with the grid, and where a time scheme turns its old levels instead.
  bool turning_source = true;
  /// Takes the place of `grid` when there is one; outlives the conditions.
  const FaceSpeeds* face_speeds = nullptr;
  /// A gust whose velocity `face_speeds` holds; outlives the conditions.
  const GustInCells* gust = nullptr;

  /// Speed of an interior face along its unit normal.
  T face_speed(Index face, const Vec3& center, const Vec3& normal) const {
    return face_speeds ? T(face_speeds->interior[static_cast<std::size_t>(face)])
                       : grid.normal_speed(center, normal);
  }
  /// Volume that an interior face sweeps per unit of time; `area` is its area vector.
  T face_sweep(Index face, const Vec3& center, const Vec3& area) const {
    return face_speeds ? T(norm(area) * face_speeds->interior[static_cast<std::size_t>(face)])
                       : dot(grid.at(center), area);
  }
  /// Speed of a boundary face along its unit normal.
  T boundary_speed(std::size_t face, const Vec3& center, const Vec3& normal) const {
    return face_speeds ? T(face_speeds->boundary[face]) : grid.normal_speed(center, normal);
  }
};

/// What a cell gains per unit volume, as an outflow, from axes that turn: rho rotation x (u - turning stream)
/// and the work of that, none while the turning stream is zero.
template <class T>
Conserved<T> turning_source(const Primitive<T>& w, const Conditions<T>& conditions) {
  const auto turn = w[0] * cross(conditions.grid.rotation, velocity(w) - conditions.turning_stream);
  return {{T(0), turn.x, turn.y, turn.z, dot(velocity(w), turn)}};
}

/// What a cell gains, as an outflow, from a gust that varies in space. The flow's velocity u is that of the
/// air less the gust's g; with it the momentum balance gains rho Dg/Dt, and the energy balance u times that
/// (G. Wales, D. Jones & A. Gaitonde, J. Aircraft 52, 2015, 151: split velocity, all its sources). A gust
/// that is at rest in the undisturbed air u0 has Dg/Dt = (u + g - u0) . grad g, and g is normal to grad g.
/// The same is taken of a pattern that comes at another speed: something else than the body holds it. The
/// uniform stream is then a solution, also on the mesh: what g's flow through the faces of a cell lacks to
/// zero is taken off.
template <class T>
Conserved<T> gust_source(const Primitive<T>& w, const Conditions<T>& conditions, std::size_t cell,
                         Real gamma) {
  const GustInCells& gust = *conditions.gust;
  const T across = dot(velocity(w) - velocity(conditions.free_stream), gust.front);
  const Vec3Of<T> push = T(w[0] * across * gust.slope[cell]) * gust.direction;
  const Conserved<T> lack = T(gust.divergence[cell]) * conserved(w, gamma);
  return {{-lack[0], push.x - lack[1], push.y - lack[2], push.z - lack[3], dot(velocity(w), push) - lack[4]}};
}

/// Conditions of the field velocity approach: a still mesh, everything along body axes.
inline Conditions<Real> field_velocity_conditions(const Attitude& attitude, const Vec3& wind,
                                                  const Vec3& axis_point, Real gamma) {
  return {free_stream(on_turned_axes(wind, attitude.angle), gamma),
          {on_turned_axes(attitude.velocity, attitude.angle),
           on_turned_axes(attitude.rotation, attitude.angle), axis_point},
          {}};
}

/// Conditions of steady flight at fixed incidence, the flight path turning with the body's `rotation`.
inline Conditions<Real> steady_conditions(const Vec3& wind, const Vec3& axis_point, Real gamma,
                                          const Vec3& rotation = {}) {
  return {free_stream(wind, gamma), {{}, rotation, axis_point}, wind};
}

}  // namespace alphadot
