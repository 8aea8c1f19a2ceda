// Matrix-free LU-SGS, the implicit operator of the paper.
#pragma once

#include <vector>

#include "linear/linear_solver.hpp"

namespace alphadot {

/// Lower-upper symmetric Gauss-Seidel with a scalar diagonal (Yoon & Jameson 1988; on unstructured meshes
/// Sharov & Nakahashi 1997): the flux Jacobian is split as (A +- lambda) / 2, so that row i reads
///   (V/dtau + V/dt_bdf + sum lambda S / 2) dU_i + sum_j (dF_j . n - lambda dU_j) S / 2 = -R_i,
/// with dF_j the true change of the flux of neighbour j. Nothing but lambda is stored. Hybrid across ranks:
/// halos are renewed between the forward and the backward sweep.
class LuSgs final : public LinearSolver {
 public:
  LuSgs(const Discretization& discretization, const Communicator& comm);

  void linearise(const FlowField<Real>& flow, const Conditions<Real>& conditions,
                 const TimeTerms& time) override;
  void solve(std::span<const LinearSystem> systems) override;
  std::size_t bytes() const override;
  HaloTraffic halo_traffic() const override { return update_.halo().traffic(); }

 private:
  void solve_one(const LinearSystem& system);
  /// Sum over the neighbours of `row` of the off-diagonal terms.
  Conserved<Real> off_diagonal(Index row) const;

  const Discretization& discretization_;
  const FlowField<Real>* flow_ = nullptr;  // of the latest linearise()
  Conditions<Real> conditions_{};
  std::vector<Real> face_wave_;  // [faces] lambda S / 2
  std::vector<Real> diagonal_;   // [owned_cells]
  CellField<Conserved<Real>> update_;
};

}  // namespace alphadot
