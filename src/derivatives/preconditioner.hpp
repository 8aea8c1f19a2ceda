// The implicit scheme as the preconditioner of linear solves about a steady flow.
#pragma once

#include <array>
#include <span>
#include <stdexcept>
#include <vector>

#include "linear/block_lu_sgs.hpp"
#include "march/implicit_iteration.hpp"

namespace alphadot {

enum class Transposed { no, yes };

/// As bold as the flow lets it be: its time term is none to speak of, and what damps it where its passes over
/// the plain Jacobian would grow in some cells.
class Preconditioner {
 public:
  /// About the flow of `iteration`, whose linear solver it takes. Throws std::logic_error when a scheme other
  /// than block LU-SGS is to be transposed. Collective.
  Preconditioner(ImplicitIteration& iteration, const Conditions<Real>& conditions,
                 Transposed transposed = Transposed::no)
      : iteration_(iteration), conditions_(conditions), transposed_(transposed) {
    linearise(0);
  }
  bool can_be_damped() const { return level_ + 1 < cfl.size(); }
  /// Gives it more of a time term. Collective.
  void damp() { linearise(level_ + 1); }
  void solve(std::span<const LinearSystem> systems) { scheme().solve(systems); }

  /// Whether a defect, by its norms so far, falls too little for a preconditioner that suits.
  static bool has_stalled(std::span<const Real> norms) {
    constexpr Real stalled_share = 0.7;
    return norms.size() > stalled_iterations &&
           !(norms.back() < stalled_share * norms[norms.size() - 1 - stalled_iterations]);
  }
  /// Iterations that it takes to tell.
  static constexpr std::size_t stalled_iterations = 10;

 private:
  static constexpr std::array cfl{1e8, 1e3, 1e2, 1e1, 1.0};

  LinearSolver& scheme() { return iteration_.linear_solver(); }
  void linearise(std::size_t level) {
    level_ = level;
    scheme().linearise(iteration_.flow(), conditions_, {.cfl = cfl[level]});
    if (transposed_ == Transposed::no) return;
    auto* block = dynamic_cast<BlockLuSgs*>(&scheme());
    if (!block) throw std::logic_error("of the implicit schemes only block LU-SGS has a transpose");
    block->transpose();
  }

  ImplicitIteration& iteration_;
  const Conditions<Real>& conditions_;
  Transposed transposed_;
  std::size_t level_ = 0;
};

}  // namespace alphadot
