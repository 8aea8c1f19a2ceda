// GMRES around another implicit scheme, with the exact derivative of the second-order residual.
#pragma once

#include <optional>
#include <vector>

#include "linear/krylov_basis.hpp"
#include "linear/linear_solver.hpp"
#include "linear/tangent.hpp"

namespace alphadot {

/// Newton-Krylov steps: the scheme inside, linearised about the first-order flux, is the preconditioner of a
/// Krylov space for the second-order operator. Each direction costs one tangent and one solve of the scheme
/// inside; the space ends when the preconditioned residual has dropped enough for one step of Newton's
/// method.
class Gmres final : public LinearSolver {
 public:
  /// For steps on `residual`, whose latest evaluation is at the flow of linearise(); at most so many
  /// directions a solve. Residual and scheme must outlive this.
  Gmres(const Discretization& discretization, const Communicator& comm, const Residual& residual,
        LinearSolver& inside, int directions);

  void linearise(const FlowField<Real>& flow, const Conditions<Real>& conditions,
                 const TimeTerms& time) override;
  void solve(std::span<const LinearSystem> systems) override;
  /// Beside those of the scheme inside.
  std::size_t bytes() const override;
  /// Beside that of the scheme inside.
  HaloTraffic halo_traffic() const override { return {}; }

 private:
  void solve_one(const LinearSystem& system);
  /// out = (time terms + dR/dW) direction.
  void apply(std::span<const Primitive<Real>> direction, std::span<Conserved<Real>> out);

  const Discretization& discretization_;
  const Communicator& comm_;
  const Residual& residual_;
  LinearSolver& inside_;
  KrylovBasis<Real> space_;
  std::optional<Linearisation> linearisation_;
  std::optional<Tangent<1>> tangent_;
  std::vector<Real> time_scale_;          // [owned_cells] of dU/dW
  std::vector<Primitive<Real>> defect_;   // [owned_cells]
  std::vector<Primitive<Real>> image_;    // [owned_cells]
  std::vector<Conserved<Real>> product_;  // [owned_cells]
};

}  // namespace alphadot
