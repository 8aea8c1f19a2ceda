// Cell gradients, limited, and the states they give on faces.
#pragma once

#include <array>
#include <vector>

#include "core/communicator.hpp"
#include "solver/discretization.hpp"
#include "solver/flow_field.hpp"

namespace alphadot {

/// Derivatives of the primitive state along x, y and z.
template <class T>
struct Gradient {
  Primitive<T> along[3];
};

/// state + gradient . offset
template <class T>
Primitive<T> extrapolated(const Primitive<T>& state, const Gradient<T>& gradient, const Vec3& offset) {
  Primitive<T> out;
  for (int i = 0; i < 5; ++i)
    out[i] = state[i] + (offset.x * gradient.along[0][i] + offset.y * gradient.along[1][i] +
                         offset.z * gradient.along[2][i]);
  return out;
}

/// Limited gradients of a flow field. T is Real, or a dual number for the tangent.
template <class T>
class Reconstruction {
 public:
  Reconstruction(const Discretization& discretization, const Communicator& comm);

  /// Fills the gradients of owned cells from a flow whose exchange has been started; finishes it while the
  /// cells that need no ghost are worked on. Two passes: moments and extrema of the points, then gradient and
  /// limiter of the cells.
  void update(FlowField<T>& flow);
  /// From now on the limiter's factors stay what they were in the latest update (or are free again).
  void freeze_limiter(bool frozen) { frozen_ = frozen; }
  bool limiter_is_frozen() const { return frozen_; }
  /// [owned_cells] of the latest evaluation; empty when the case never freezes them.
  std::span<Five<float>> limiter_factors() { return factors_; }
  /// Brings the gradients of face ghosts up to date.
  void start_exchange() { gradients_.start_exchange(); }
  void finish_exchange() { gradients_.finish_exchange(); }

  const Gradient<T>& operator[](Index cell) const { return gradients_[cell]; }
  std::size_t bytes() const;
  const HaloExchange<Gradient<T>>& halo() const { return gradients_.halo(); }

 private:
  /// Sums over the cells j around a point v: values, values times (c_j - x_v), and extrema.
  struct PointSums {
    Primitive<T> value;
    Gradient<T> moment;
    Primitive<T> minimum, maximum;
  };
  /// Vectors from the corners of a cell to its centroid.
  using Arms = std::array<Vec3, 4>;

  void gather_points(const FlowField<T>& flow, Index begin, Index end);
  void fit_cells(const FlowField<T>& flow, Index begin, Index end);
  template <LimiterKind limiter>
  void fit_limited(const FlowField<T>& flow, Index begin, Index end);
  Gradient<T> least_squares(Index cell, const Arms& arms, const Primitive<T>& w) const;
  Gradient<T> green_gauss(Index cell) const;
  template <LimiterKind limiter>
  Primitive<T> limiter_factors(Index cell, const Arms& arms, const Primitive<T>& w,
                               const Gradient<T>& gradient) const;

  const Discretization& discretization_;
  CellField<Gradient<T>> gradients_;
  std::vector<PointSums> points_;     // [owned_points]
  std::vector<Five<float>> factors_;  // [owned_cells] of the limiter, when the case may freeze it
  bool frozen_ = false;
};

}  // namespace alphadot
