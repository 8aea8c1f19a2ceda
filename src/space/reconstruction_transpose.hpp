// The transpose of gradients and limiter: what a functional of limited gradients says about the flow.
#pragma once

#include <span>
#include <vector>

#include "space/reconstruction.hpp"

namespace alphadot {

/// With g = L F W, the changes of limited gradients with those of the flow (Reconstruction<Changes<N>>):
/// takes adjoints of g, adds F^T L^T of them to adjoints of W. In two steps, as the way there: cells undo
/// limiter and fit, then points hand what their cells ask of them to the cells around. The sums of a point
/// live no longer than its turn. 480 bytes a cell for N = 3 or 4.
template <int N>
class ReconstructionTranspose {
 public:
  /// The slopes are those of the limiter that the flow follows, or none; they must outlive this.
  ReconstructionTranspose(const Discretization& discretization, const LimiterSlopes& slopes);

  /// Adjoints of the states of all local cells, [total_cells].
  using States = std::span<Primitive<Changes<N>>>;

  /// Adjoint of the limited gradient of an owned cell, to be added to after clear().
  Gradient<Changes<N>>& operator[](Index cell) { return gradients_[static_cast<std::size_t>(cell)]; }
  std::span<const Gradient<Changes<N>>> gradients() const { return gradients_; }
  void clear();
  /// Limiter and fit of the cells [begin, end); once for each.
  void fit_cells(Index begin, Index end, States states);
  /// Sums of the points [begin, end), after the cells around them that are owned.
  void scatter_points(Index begin, Index end, States states) const;

  std::size_t bytes() const { return gradients_.size() * sizeof(gradients_[0]); }

 private:
  void follow_limiter(Index cell, States states);
  void least_squares(Index cell, States states);
  void scatter_moments(Index point, States states) const;
  void scatter_value(Index point, States states) const;

  const Discretization& discretization_;
  const LimiterSlopes& slopes_;
  /// [owned_cells] adjoints of limited gradients; after fit_cells(), of what points give to the fit: the
  /// right-hand side of least squares, or the gradient by Green and Gauss.
  std::vector<Gradient<Changes<N>>> gradients_;
};

}  // namespace alphadot
