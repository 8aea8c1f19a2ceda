// Block LU-SGS: symmetric Gauss-Seidel sweeps over the stored first-order Jacobian.
#pragma once

#include <vector>

#include "solver/block_matrix.hpp"
#include "solver/linear_solver.hpp"

namespace alphadot {

/// Update of one cell in the precision of the sweeps; padded to a vector register.
struct alignas(32) SweepState {
  float v[8]{};
};

/// Jacobian of the first-order flux, exact for the flux in use (forward differentiation), swept forward and
/// backward. Across ranks the sweeps are hybrid: Gauss-Seidel within a rank, with halos renewed before every
/// direction.
class BlockLuSgs final : public LinearSolver {
 public:
  /// `sweeps`: pairs of a forward and a backward pass in each solve.
  BlockLuSgs(const Discretization& discretization, const Communicator& comm, int sweeps);

  void linearise(const FlowField<Real>& flow, const Conditions<Real>& conditions,
                 const TimeTerms& time) override;
  void solve(std::span<const Conserved<Real>> residual, std::span<Primitive<Real>> update) override;
  std::size_t bytes() const override;
  Real halo_seconds() const override { return update_.halo().wait_seconds(); }

 private:
  enum class Direction { forward, backward };
  void sweep(Direction direction, std::span<const Conserved<Real>> residual);

  const Discretization& discretization_;
  int sweeps_;
  BlockMatrix matrix_;
  CellField<SweepState> update_;
};

}  // namespace alphadot
