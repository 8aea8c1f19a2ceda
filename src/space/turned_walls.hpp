// Walls that have turned on a mesh that stays: gas passes their faces as it would flow there along the turned
// wall (transpiration; M. J. Lighthill, J. Fluid Mech. 4, 1958, 383).
#pragma once

#include "euler/boundary.hpp"
#include "space/conditions.hpp"
#include "space/face_geometry.hpp"
#include "space/reconstruction.hpp"

namespace alphadot {

/// What the turned wall has to say about the gas at its face.
template <class T>
struct TurnedWallFlux {
  T pressure;         ///< on the turned wall
  Conserved<T> flux;  ///< out of the face of the mesh, per area
};

/// `here` and `there` are what the cell carries to its face and to where the wall now is, with the speeds of
/// the wall along the unit normals of either. That no gas crosses the wall there, u_there . n_turned =
/// speed_there, is to first order in the turn a flow through the face here,
///   (u_here . n - speed_here) - (u_there . n_turned - speed_there):
/// the change of the normal and the gradient of the velocity along the way. Gas that comes in is that of the
/// cell.
template <class T>
TurnedWallFlux<T> turned_wall_flux(const Primitive<T>& here, const Vec3& normal, const T& speed_here,
                                   const Primitive<T>& there, const Vec3& turned_normal, const T& speed_there,
                                   Real gamma) {
  const T into_here = dot(velocity(here), normal) - speed_here;
  const T into_there = dot(velocity(there), turned_normal) - speed_there;
  const T through = into_here - into_there, speed = speed_here + through;
  Primitive<T> passing = here;
  passing[4] = wall_pressure(here, normal, speed, gamma);
  for (int i = 0; i < 3; ++i) passing[i + 1] = here[i + 1] - into_there * normal[i];
  return {wall_pressure(there, turned_normal, speed_there, gamma),
          wall_flux(passing[4], normal, speed) + through * conserved(passing, gamma)};
}

/// Where the wall of a face has come to.
inline FaceGeometry turned_geometry(const Subdomain& domain, const TurnedWall& wall) {
  const auto face = static_cast<std::size_t>(wall.face);
  return {norm(domain.boundary_normal[face]), wall.normal, domain.boundary_center[face] + wall.shift};
}

/// Its speed along its normal there.
template <class T>
T turned_speed(const TurnedWall& wall, const FaceGeometry& turned, const Conditions<T>& conditions) {
  return conditions.boundary_speed(static_cast<std::size_t>(wall.face), turned.center, turned.normal) +
         T(wall.speed);
}

}  // namespace alphadot
