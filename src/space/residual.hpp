// The spatial operator: net flux out of every cell.
#pragma once

#include <span>
#include <vector>

#include "space/conditions.hpp"
#include "space/discretization.hpp"
#include "space/flow_field.hpp"
#include "space/reconstruction.hpp"

namespace alphadot {

/// R(W) of the semi-discrete equations V dU/dt + R = 0.
class Residual {
 public:
  Residual(const Discretization& discretization, const Communicator& comm);

  /// Fills residual[owned_cells] with the net flux out of each cell plus the momentum source of rotating
  /// axes and of gusts and its work; brings the ghosts of `flow` up to date. `order` 1 leaves the gradients
  /// out.
  void evaluate(FlowField<Real>& flow, const Conditions<Real>& conditions, int order,
                std::span<Conserved<Real>> residual);

  /// Gradients of the latest second-order evaluation.
  const Reconstruction<Real>& reconstruction() const { return reconstruction_; }
  /// Holds the limiter's factors, or lets them go.
  void freeze_limiter(bool frozen) { reconstruction_.freeze_limiter(frozen); }
  std::span<Five<float>> limiter_factors() { return reconstruction_.limiter_factors(); }
  /// Faces on this rank where the latest evaluation used less than the whole limited gradients to keep
  /// density and pressure positive.
  Index positivity_faces() const { return positivity_faces_; }
  /// [boundary_faces] pressure in the latest evaluation: on walls and symmetry planes that which acts on
  /// them, elsewhere that of the gas inside.
  std::span<const Real> boundary_pressures() const { return boundary_pressures_; }

  std::size_t bytes() const { return reconstruction_.bytes() + boundary_pressures_.size() * sizeof(Real); }

 private:
  struct FaceBatch;

  void interior_faces(const FlowField<Real>& flow, const Conditions<Real>& conditions, int order, Index begin,
                      Index end, std::span<Conserved<Real>> residual);
  /// Gives those of some faces beside dissipative cells their flux.
  void dissipate(Index first, int count, FaceBatch& batch);
  void boundary_faces(const FlowField<Real>& flow, const Conditions<Real>& conditions, int order,
                      std::span<Conserved<Real>> residual);
  /// Gives some faces the flux of walls that have turned instead.
  void turned_walls(const FlowField<Real>& flow, const Conditions<Real>& conditions, int order,
                    std::span<Conserved<Real>> residual);
  void rotating_axes(const FlowField<Real>& flow, const Conditions<Real>& conditions,
                     std::span<Conserved<Real>> residual);
  void gusts(const FlowField<Real>& flow, const Conditions<Real>& conditions,
             std::span<Conserved<Real>> residual);

  const Discretization& discretization_;
  Reconstruction<Real> reconstruction_;
  std::vector<Real> boundary_pressures_;
  Index positivity_faces_ = 0;
};

}  // namespace alphadot
