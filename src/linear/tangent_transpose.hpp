// The transpose of the second-order residual's derivative, of the loads' and of the conditions'.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "linear/tangent.hpp"
#include "partition/reverse_halo.hpp"
#include "space/reconstruction_transpose.hpp"

namespace alphadot {

/// What Tangent<N> takes is what this gives, and the other way round: from adjoints of the residual and
/// weights of the loads, the sensitivity of  sum adjoint . R + sum weight . load  to the flow and to the
/// conditions, N functionals at once, from the same matrices of a linearisation, which must outlive this. 1
/// to 1.3 times the time of a tangent.
template <int N>
class TangentTranspose {
 public:
  TangentTranspose(const Linearisation& linearisation, const Vec3& moment_center);

  using Adjoints = std::array<std::span<const Conserved<Real>>, N>;  ///< [owned_cells] each
  using Weights = std::array<std::span<const Load>, N>;              ///< of every patch's load, or none
  using Images = std::array<std::span<Primitive<Real>>, N>;          ///< [owned_cells] each

  /// images[k] = (dR/dW)^T adjoints[k] + (dloads/dW)^T weights[k] in every owned cell. Exchanges halos.
  void apply(const Adjoints& adjoints, const Weights& weights, const Images& images);
  /// Half of the way, [owned_cells]: the same for limited gradients at held states. Until the next call.
  std::span<const Gradient<Changes<N>>> limited_gradients(const Adjoints& adjoints, const Weights& weights);
  /// (dR/dconditions)^T adjoints[k] + (dloads/dconditions)^T weights[k], the adjoints being those of the
  /// latest apply(); this rank's part of a sum over all.
  std::array<ConditionsChange, N> conditions(const Weights& weights) const;

  std::size_t bytes() const;

 private:
  /// Flux that a face carries from left to right, as the adjoints see it.
  Conserved<Changes<N>> across(const FaceCells& cells) const;
  Changes<N> pressure_weights(std::size_t boundary_face, const Vec3& area, const Vec3& at,
                              const Weights& weights) const;
  Changes<N> pressure_weights(std::size_t boundary_face, const Weights& weights) const;
  /// Fluxes and pressures, back to states and limited gradients.
  void faces(const Adjoints& adjoints, const Weights& weights);
  void boundary_faces(const Weights& weights);
  void turned_faces(const Weights& weights);
  void cells(Index begin, Index end);
  void turn_axes();

  const Linearisation& linearisation_;
  const Discretization& discretization_;
  Vec3 moment_center_;
  CellField<Conserved<Changes<N>>> adjoints_;
  std::vector<Primitive<Changes<N>>> states_;  // [total_cells] sensitivity to the states
  ReverseHaloExchange<Primitive<Changes<N>>> states_halo_;
  ReconstructionTranspose<N> reconstruction_;
};

}  // namespace alphadot
