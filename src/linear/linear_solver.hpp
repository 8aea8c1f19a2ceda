// What the drivers ask of an implicit scheme: an approximate solution of one linearised step.
#pragma once

#include <memory>
#include <span>

#include "space/conditions.hpp"
#include "space/discretization.hpp"
#include "space/flow_field.hpp"

namespace alphadot {

/// Pseudo and physical time terms of the diagonal: V (1 / dtau + bdf / dt) dU/dW with dtau = cfl * V / (sum
/// of wave speeds through the faces of the cell).
struct TimeTerms {
  Real cfl;               ///< of the local pseudo time step
  Real inverse_step = 0;  ///< 3 / (2 dt) in dual time, else 0
};

/// One right-hand side and its solution, both [owned_cells].
struct LinearSystem {
  std::span<const Conserved<Real>> residual;
  std::span<Primitive<Real>> update;
};

/// An approximate inverse of V d/dt + dR/dW, in primitive variables.
class LinearSolver {
 public:
  virtual ~LinearSolver() = default;
  /// Linearises about `flow` (its ghosts current). May be skipped for a few iterations.
  virtual void linearise(const FlowField<Real>& flow, const Conditions<Real>& conditions,
                         const TimeTerms& time) = 0;
  /// Solves (time terms + dR/dW) update = -residual roughly, for several right-hand sides at once.
  /// Communicates.
  virtual void solve(std::span<const LinearSystem> systems) = 0;
  virtual std::size_t bytes() const = 0;
  virtual HaloTraffic halo_traffic() const = 0;
};

}  // namespace alphadot
