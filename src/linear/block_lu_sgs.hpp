// Block LU-SGS: symmetric Gauss-Seidel sweeps over the stored first-order Jacobian.
#pragma once

#include <memory>
#include <vector>

#include "linear/block_matrix.hpp"
#include "linear/linear_solver.hpp"

namespace alphadot {

/// Update of one cell in the precision of the sweeps; padded to a vector register.
struct alignas(32) SweepState {
  float v[8]{};
};

/// The directions of the passes over the cells, which are stored in the order of their x. A disturbance of
/// flow that is supersonic in that direction travels with it: a forward pass carries it from cell to cell to
/// the end, a backward one by one cell only. There all passes but one go forward. In other flow it travels
/// both ways, and passes alternate as in LU-SGS of old.
enum class PassOrder { alternating, downstream };

/// What suits a free stream with this Mach number along x.
PassOrder pass_order(Real mach_along_x);

/// Pairs of passes that suit the order, in a march to a steady flow and in its linear solves. On 42,388 cells
/// around the Basic Finner at Mach 0.3 to 0.95 ten decades take half the processor with 16 alternating pairs
/// of what they take with 4 and Newton-Krylov steps around them, on 132,580 cells the same; downstream passes
/// gain nothing beyond 4 pairs. With a time step nothing travels far, and 4 are enough.
int pass_pairs(PassOrder order, bool is_steady);

/// Jacobian of the first-order flux, exact for the flux in use (forward differentiation), swept forward and
/// backward. Across ranks the sweeps are hybrid: Gauss-Seidel within a rank, with halos renewed before every
/// pass. Rows next to ghosts come last in a forward pass and first in a backward one, so that the halo before
/// a forward pass travels while the interior is worked on. Right-hand sides that are solved together share
/// the reading of the matrix, which is what a sweep costs.
class BlockLuSgs final : public LinearSolver {
 public:
  /// `sweeps`: pairs of passes in each solve; 0: as suits order and time terms.
  BlockLuSgs(const Discretization& discretization, const Communicator& comm, int sweeps,
             PassOrder order = PassOrder::alternating);

  void linearise(const FlowField<Real>& flow, const Conditions<Real>& conditions,
                 const TimeTerms& time) override;
  void solve(std::span<const LinearSystem> systems) override;
  /// From now on solve() is the exact transpose of what it was, residual and update having changed places,
  /// until the next transpose() or linearise(): the same passes over the transposed matrix, in the opposite
  /// order and direction. Where they go downstream, those of the transpose go upstream. Collective.
  void transpose();
  std::size_t bytes() const override;
  HaloTraffic halo_traffic() const override;

 private:
  enum class Direction { forward, backward };
  Direction direction(int pass) const;
  /// Relaxes the rows [begin, end) once, for the first N right-hand sides.
  template <int N>
  void sweep(Direction direction, Index begin, Index end);
  template <int N>
  void solve_together(std::span<const LinearSystem> systems);

  /// One right-hand side: minus the residual times the inverse diagonal, [owned_cells], and its solution. Of
  /// the transpose, whose blocks are scaled by columns: minus the residual, and the solution times the
  /// diagonal.
  struct System {
    System(const Subdomain& domain, const Communicator& comm);
    std::vector<SweepState> right;
    CellField<SweepState> update;
  };

  const Discretization& discretization_;
  const Communicator& comm_;
  int asked_sweeps_, sweeps_;
  PassOrder order_;
  bool is_transposed_ = false;
  BlockMatrix matrix_;
  std::vector<std::unique_ptr<System>> systems_;  // as many as were ever solved together
};

}  // namespace alphadot
