// Cell gradients, limited, and the states they give on faces.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <type_traits>
#include <vector>

#include "core/changes.hpp"
#include "core/communicator.hpp"
#include "core/four.hpp"
#include "space/discretization.hpp"
#include "space/flow_field.hpp"

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

/// The same for plain numbers: four variables in a vector register, the last one by itself.
inline Primitive<Real> extrapolated(const Primitive<Real>& state, const Gradient<Real>& gradient,
                                    const Vec3& offset) {
  const auto& [x, y, z] = gradient.along;
  Primitive<Real> out;
  store_four(load_four(state.v) +
                 (offset.x * load_four(x.v) + offset.y * load_four(y.v) + offset.z * load_four(z.v)),
             out.v);
  out[4] = state[4] + (offset.x * x[4] + offset.y * y[4] + offset.z * z[4]);
  return out;
}

/// Share of a reconstruction that a face may use: all of it while the state on the face keeps a fifth of the
/// cell's density and pressure, in proportion below, none of it at vacuum. A limiter that is not frozen
/// leaves every face more than that. Continuous, so that a march can come to rest at such a face.
template <class T>
T usable_share(const Primitive<T>& face, const Primitive<T>& cell) {
  constexpr Real kept = 0.2;
  if (face[0] >= kept * cell[0] && face[4] >= kept * cell[4]) return T(1);
  const T density = face[0] / cell[0], pressure = face[4] / cell[4];
  const T lowest = density < pressure ? density : pressure;
  return lowest > T(0) ? T(lowest / kept) : T(0);
}

/// How the limited gradient of one cell follows a small change of the flow:
///   d(phi g) = phi dg + g (by_delta ddelta + by_bound dbound)
/// in each variable, delta and bound being those of the corner that limits it most (see limiter.hpp).
struct LimiterSlope {
  Primitive<Real> factor;   ///< phi
  Gradient<Real> gradient;  ///< g
  Primitive<Real> by_delta, by_bound;
  Primitive<Real> by_density, by_pressure;  ///< of the cell itself, which set what passes the limiter
  std::array<std::uint8_t, 5> corner;
  std::array<Index, 5> extremum;  ///< the cell whose value gives the bound
};

/// Limited gradients of a flow field, or (T = Changes) their changes with it.
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
  /// Owned cells whose limiter's factors also keep density and pressure positive, when they last changed.
  Index positivity_cells() const { return positivity_cells_; }
  /// Brings the gradients of face ghosts up to date.
  void start_exchange() { gradients_.start_exchange(); }
  void finish_exchange() { gradients_.finish_exchange(); }

  /// Of every owned cell, at the flow of the latest update (T = Real); none without a limiter. About what a
  /// few updates cost.
  std::vector<LimiterSlope> limiter_slopes(const FlowField<T>& flow) const requires std::is_same_v<T, Real>;
  /// T = Changes: the slopes of the flow that changes, which must outlive the use; without any, gradients are
  /// not limited.
  void follow(std::span<const LimiterSlope> slopes) { slopes_ = slopes; }

  const Gradient<T>& operator[](Index cell) const { return gradients_[cell]; }
  std::size_t bytes() const;
  const HaloExchange<Gradient<T>>& halo() const { return gradients_.halo(); }

 private:
  struct Extrema {
    Primitive<T> minimum, maximum;
  };
  struct NoExtrema {};
  /// Over the cells j around a point v, variable by variable: sums of q_j times (c_j - x_v, 1); and extrema.
  struct PointSums : std::conditional_t<is_change<T>, NoExtrema, Extrema> {
    std::array<Four<T>, 5> moments;
  };
  /// Vectors from the corners of a cell to its centroid.
  using Offsets = std::array<Vec3, 4>;

  void gather_points(const FlowField<T>& flow, Index begin, Index end);
  void fit_cells(const FlowField<T>& flow, Index begin, Index end);
  template <LimiterKind limiter>
  void fit_limited(const FlowField<T>& flow, Index begin, Index end);
  Gradient<T> least_squares(Index cell, const Offsets& offsets, const Primitive<T>& w) const;
  Gradient<T> green_gauss(Index cell) const;
  Offsets offsets_of(Index cell) const;
  Gradient<T> unlimited(Index cell, const Offsets& offsets, const Primitive<T>& w) const;
  template <LimiterKind limiter>
  Primitive<T> limiter_factors(Index cell, const Offsets& offsets, const Primitive<T>& w,
                               const Gradient<T>& gradient);
  template <LimiterKind limiter>
  void follow_limiter(Index cell, const FlowField<T>& flow, const Offsets& offsets,
                      Gradient<T>& gradient) const;
  template <LimiterKind limiter>
  LimiterSlope limiter_slope(Index cell, const FlowField<T>& flow) const;

  const Discretization& discretization_;
  CellField<Gradient<T>> gradients_;
  std::vector<PointSums> points_;     // [owned_points]
  std::vector<Five<float>> factors_;  // [owned_cells] of the limiter, when the case may freeze it
  bool frozen_ = false;
  Index positivity_cells_ = 0;
  std::span<const LimiterSlope> slopes_;  // [owned_cells] or none
};

}  // namespace alphadot
