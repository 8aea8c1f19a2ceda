// The derivative of the second-order residual, by running the very same residual in dual numbers.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "core/dual.hpp"
#include "solver/forces.hpp"
#include "solver/residual.hpp"

namespace alphadot {

/// Change of the conditions that goes with one unit of a flight variable. The free stream turns with the
/// axes, as in steady rotation.
struct ConditionsChange {
  Vec3 wind;           ///< of the free-stream velocity
  Vec3 grid_velocity;  ///< of the axis point
  Vec3 rotation;
};

/// Directional derivatives of R(W, conditions) and of the wall loads in N directions at once.
template <int N>
class Tangent {
 public:
  /// About a flow whose conditions are those given. Neither is changed.
  Tangent(const Discretization& discretization, const Communicator& comm, const FlowField<Real>& flow,
          const Conditions<Real>& conditions, const Vec3& moment_center);

  using Fields = std::array<std::span<const Primitive<Real>>, N>;
  using Images = std::array<std::span<Conserved<Real>>, N>;

  /// images[k] = (dR/dW) fields[k] + (dR/dconditions) changes[k] in every owned cell. Exchanges halos.
  void apply(const Fields& fields, const std::array<ConditionsChange, N>& changes, const Images& images);
  /// Change of every patch's load that goes with the fields of the latest apply(), of this rank only.
  std::array<std::vector<Load>, N> loads() const;

  std::size_t bytes() const {
    return flow_.bytes() + residual_.bytes() + values_.size() * sizeof(values_[0]);
  }

 private:
  const Discretization& discretization_;
  Conditions<Real> conditions_;
  Vec3 moment_center_;
  FlowField<Dual<N>> flow_;
  Residual<Dual<N>> residual_;
  std::vector<Conserved<Dual<N>>> values_;
};

}  // namespace alphadot
