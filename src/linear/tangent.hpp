// The derivative of the second-order residual along changes of the flow and of its conditions.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "core/changes.hpp"
#include "linear/linearisation.hpp"
#include "space/forces.hpp"

namespace alphadot {

/// Change of the conditions that goes with one unit of a flight variable. The free stream turns with the
/// axes, as in steady rotation.
struct ConditionsChange {
  Vec3 wind;           ///< of the free-stream velocity, in units of a_inf
  Vec3 grid_velocity;  ///< of the axis point, in units of a_inf
  Vec3 rotation;       ///< angular velocity, a_inf over the unit of the subdomain's lengths
};

/// Directional derivatives of R(W, conditions) and of the wall loads in N directions at once. What is linear
/// in the residual is done to the changes as it is done to the flow; the rest are products with the matrices
/// of a linearisation, which must outlive this.
template <int N>
class Tangent {
 public:
  Tangent(const Linearisation& linearisation, const Vec3& moment_center);

  using Fields = std::array<std::span<const Primitive<Real>>, N>;
  using Images = std::array<std::span<Conserved<Real>>, N>;

  /// images[k] = (dR/dW) fields[k] + (dR/dconditions) changes[k] in every owned cell. Exchanges halos.
  void apply(const Fields& fields, const std::array<ConditionsChange, N>& changes, const Images& images);
  /// Change of every patch's load that goes with the fields of the latest apply(), of this rank only.
  std::array<std::vector<Load>, N> loads() const;
  /// [boundary_faces] change of the pressure likewise.
  std::array<std::vector<Real>, N> pressures() const;

  std::size_t bytes() const {
    return flow_.bytes() + reconstruction_.bytes() + values_.size() * sizeof(values_[0]) +
           pressures_.size() * sizeof(pressures_[0]);
  }

 private:
  /// Changes of the conditions, where they are not all zero.
  struct Forcing {
    Vec3Of<Changes<N>> wind;
    GridMotion<Changes<N>> grid;
  };
  static Forcing forcing_of(const std::array<ConditionsChange, N>& changes, const Vec3& axis);

  Primitive<Changes<N>> at_face(Index cell, const Vec3& face_center, Real scaling) const;
  void interior_faces(Index begin, Index end);
  void boundary_faces();
  void turned_faces();
  void force_faces(const Forcing& forcing);
  void turn_axes(const std::array<ConditionsChange, N>& changes);

  const Linearisation& linearisation_;
  const Discretization& discretization_;
  Vec3 moment_center_;
  FlowField<Changes<N>> flow_;
  Reconstruction<Changes<N>> reconstruction_;
  std::vector<Conserved<Changes<N>>> values_;  // [owned_cells]
  std::vector<Changes<N>> pressures_;          // [boundary_faces]
};

}  // namespace alphadot
