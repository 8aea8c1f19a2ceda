// Everything the residual needs that depends on the mesh and the case but not on the flow.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "core/symmetric3.hpp"
#include "euler/boundary.hpp"
#include "euler/flux.hpp"
#include "partition/subdomain.hpp"
#include "space/settings.hpp"

namespace alphadot {

/// Sums over the cells around a point, relative to the point: that of their centroids and their number.
struct PointMoments {
  Vec3 first;
  Real count;
  /// Makes the weights 1 + lambda . (c_j - x) of the cells give the point the value of any linear field
  /// (Holmes & Connell 1989).
  Vec3 lambda;
};

/// A face of a wall that has turned while the mesh stays (turned_walls.hpp).
struct TurnedWall {
  Index face;      ///< in Subdomain::boundary_faces
  Vec3 normal;     ///< of unit length, out of the flow
  Vec3 shift;      ///< of the face's centre
  Real speed = 0;  ///< of the wall itself along that normal
};

/// Mesh with boundary conditions and reconstruction geometry of one rank.
///
/// The least-squares gradient of cell i fits, over the cells j around each of its points v,
///   sum_v sum_{j at v} ((c_j - c_i) . g - (q_j - q_i))^2 -> min,
/// so that a face neighbour counts three times, an edge neighbour twice, a corner neighbour once. Because the
/// weight belongs to the pair (v, j), both sides of the normal equations are sums over the points of the cell
/// of moments that are gathered once a point: the cost of a 60-cell stencil is that of 22 + 4 visits.
class Discretization {
 public:
  /// `patch_kinds`: treatment of every patch of the domain, in the order of its patch_names.
  /// Throws std::logic_error when their number differs.
  Discretization(const Subdomain& domain, std::vector<BoundaryKind> patch_kinds, const SpaceSettings& space,
                 Real gamma);

  /// Recomputes what depends on the metrics, after the mesh has been deformed.
  void update_geometry();
  /// From now on the marked cells, [total_cells], are dissipative: of first order, with van Leer's flux on
  /// all their faces.
  void set_dissipative(std::vector<std::uint8_t> cells);

  /// From now on these walls, in the order of their faces, are turned, and no others. They know nothing of a
  /// mesh that is moved.
  void set_turned_walls(std::vector<TurnedWall> walls) { turned_walls_ = std::move(walls); }
  const std::vector<TurnedWall>& turned_walls() const { return turned_walls_; }

  const Subdomain& domain() const { return domain_; }
  const SpaceSettings& space() const { return space_; }
  /// Lets fewer or more changes pass the limiter than the case says.
  void set_limiter_threshold(Real share) { space_.limiter_threshold = share; }
  /// Of faces between cells that are not dissipative.
  const FluxModel& flux() const { return flux_; }
  const FluxModel& dissipative_flux() const { return dissipative_flux_; }
  const FluxModel& flux_of(Index face) const { return is_dissipative(face) ? dissipative_flux_ : flux_; }
  const std::vector<std::uint8_t>& dissipative_cells() const { return dissipative_; }
  bool has_dissipative_cells() const { return !dissipative_.empty(); }
  /// Whether a cell beside a face between cells is dissipative.
  bool is_dissipative(Index face) const {
    const auto [left, right] = domain_.faces[face];
    return has_dissipative_cells() && (dissipative_[left] != 0 || dissipative_[right] != 0);
  }
  Real gamma() const { return flux_.gamma; }
  BoundaryKind kind_of(const BoundaryFace& face) const {
    return patch_kinds_[static_cast<std::size_t>(face.patch)];
  }
  const std::vector<BoundaryKind>& patch_kinds() const { return patch_kinds_; }

  const PointMoments& point_moments(Index point) const {
    return point_moments_[static_cast<std::size_t>(point)];
  }
  /// Inverse of the normal matrix of the least-squares fit; zero where the cell stays first order.
  const Symmetric3& inverse_fit(Index cell) const { return inverse_fit_[static_cast<std::size_t>(cell)]; }
  /// Whether the gradient of a cell is held at zero: of a dissipative one, and where two or more faces on
  /// walls or symmetry planes leave too little to fit.
  bool is_flat(Index cell) const { return inverse_fit(cell).xx == 0; }

  std::size_t bytes() const;

 private:
  const Subdomain& domain_;
  std::vector<BoundaryKind> patch_kinds_;
  SpaceSettings space_;
  FluxModel flux_, dissipative_flux_;
  std::vector<TurnedWall> turned_walls_;
  std::vector<std::uint8_t> dissipative_;    // [total_cells] or none
  std::vector<PointMoments> point_moments_;  // [owned_points]
  std::vector<Symmetric3> inverse_fit_;      // [owned_cells]
};

/// True for walls and planes that no flow crosses.
inline bool is_impermeable(BoundaryKind kind) {
  return kind == BoundaryKind::wall || kind == BoundaryKind::sting || kind == BoundaryKind::symmetry;
}

/// Pressure on a boundary face from the state of the gas inside at it: walls answer its speed, at symmetry
/// planes it meets its mirror image without a jump.
template <class T>
T boundary_pressure(BoundaryKind kind, const Primitive<T>& inside, const Vec3& normal, const T& grid_speed,
                    Real gamma) {
  const bool is_wall = kind == BoundaryKind::wall || kind == BoundaryKind::sting;
  return is_wall ? wall_pressure(inside, normal, grid_speed, gamma) : inside[4];
}

/// Flux out of a boundary face per area: `pressure` is boundary_pressure(), `outside` the free stream.
template <class T, class Outside>
Conserved<T> boundary_flux(BoundaryKind kind, const Primitive<T>& inside, const T& pressure,
                           const Primitive<Outside>& outside, const Vec3& normal, const T& grid_speed,
                           Real gamma) {
  return is_impermeable(kind) ? wall_flux(pressure, normal, grid_speed)
                              : far_field_flux(inside, outside, normal, grid_speed, gamma);
}

}  // namespace alphadot
