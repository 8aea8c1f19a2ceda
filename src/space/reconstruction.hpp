// Limited gradients of the cells, and the states they give on faces.
#pragma once

#include <span>
#include <type_traits>
#include <vector>

#include "core/communicator.hpp"
#include "space/limited_gradient.hpp"

namespace alphadot {

/// By which the reconstruction at a face is scaled to keep density and pressure positive: 1 while the state
/// on the face keeps a fifth of the cell's density and pressure, in proportion below, 0 at vacuum. A limiter
/// that is not frozen leaves every face more than that. Continuous, so that a march can come to rest at such
/// a face.
template <class T>
T positivity_scaling(const Primitive<T>& face, const Primitive<T>& cell) {
  constexpr Real kept = 0.2;
  if (face[0] >= kept * cell[0] && face[4] >= kept * cell[4]) return T(1);
  const T density = face[0] / cell[0], pressure = face[4] / cell[4];
  const T lowest = density < pressure ? density : pressure;
  return lowest > T(0) ? T(lowest / kept) : T(0);
}

/// Limited gradients of a flow field, or (T = Changes) their changes with it.
template <class T>
class Reconstruction {
 public:
  Reconstruction(const Discretization& discretization, const Communicator& comm);

  /// Brings the ghosts of `flow` up to date, then, unless `order` is 1, the limited gradients of owned cells
  /// and face ghosts: the one order in which work and messages overlap. Cells that need no ghost go first,
  /// the caller's work on the interior, `meanwhile`, comes while the last exchange is under way: it may use
  /// gradients of owned cells.
  template <class Work>
  void update(FlowField<T>& flow, int order, Work&& meanwhile) {
    if (order == 1) return flow.exchange(meanwhile);
    if (!frozen_) positivity_cells_ = 0;
    const Subdomain& domain = discretization_.domain();
    flow.exchange([&] { fit(flow, 0, domain.interior_points, 0, domain.interior_cells); });
    fit(flow, domain.interior_points, domain.owned_points, domain.interior_cells, domain.owned_cells);
    gradients_.exchange(meanwhile);
  }
  void update(FlowField<T>& flow, int order) {
    update(flow, order, [] {});
  }
  /// From now on the limiter's factors stay what they were in the latest update (or are free again).
  void freeze_limiter(bool frozen) { frozen_ = frozen; }
  bool limiter_is_frozen() const { return frozen_; }
  /// [owned_cells] of the latest evaluation; empty when the case never freezes them.
  std::span<Five<float>> limiter_factors() { return factors_; }
  /// Owned cells whose limiter's factors also keep density and pressure positive, when they last changed.
  Index positivity_cells() const { return positivity_cells_; }

  /// Of every owned cell, at the flow of the latest update (T = Real); none without a limiter. About what a
  /// few updates cost.
  LimiterSlopes limiter_slopes(const FlowField<T>& flow) const requires std::is_same_v<T, Real>;
  /// T = Changes: the slopes of the flow that changes, which must outlive the use; without any, gradients are
  /// not limited.
  void follow(const LimiterSlopes& slopes) { slopes_ = &slopes; }

  const Gradient<T>& operator[](Index cell) const { return gradients_[cell]; }
  std::size_t bytes() const;
  const HaloExchange<Gradient<T>>& halo() const { return gradients_.halo(); }

 private:
  /// Two passes: moments and extrema of some points, then gradient and limiter of some cells.
  void fit(const FlowField<T>& flow, Index point_begin, Index point_end, Index begin, Index end);
  template <LimiterKind limiter>
  void fit_limited(const FlowField<T>& flow, Index begin, Index end);

  const Discretization& discretization_;
  CellField<Gradient<T>> gradients_;
  std::vector<PointSums<T>> points_;  // [owned_points]
  std::vector<Five<float>> factors_;  // [owned_cells] of the limiter, when the case may freeze it
  bool frozen_ = false;
  Index positivity_cells_ = 0;
  const LimiterSlopes* slopes_ = nullptr;
};

/// States that the cells of a face carry to it, and the positivity scaling that they share (0 at order 1).
template <class T>
struct FaceStates {
  Primitive<T> left, right;
  T scaling;
};

/// Of a face between cells. At `order` 1 the states of the cells.
template <class T>
FaceStates<T> face_states(const Subdomain& domain, const FlowField<T>& flow,
                          const Reconstruction<T>& reconstruction, Index face, int order) {
  const auto [left, right] = domain.faces[face];
  const Primitive<T>&wl = flow[left], &wr = flow[right];
  if (order == 1) return {wl, wr, T(0)};
  const Vec3& center = domain.face_center[face];
  const auto l = extrapolated(wl, reconstruction[left], center - domain.center[left]);
  const auto r = extrapolated(wr, reconstruction[right], center - domain.center[right]);
  const T of_left = positivity_scaling(l, wl), of_right = positivity_scaling(r, wr);
  const T scaling = of_left < of_right ? of_left : of_right;
  if (scaling < T(1)) return {wl + scaling * (l - wl), wr + scaling * (r - wr), scaling};
  return {l, r, T(1)};
}

/// State that a cell carries to its boundary face, and its positivity scaling (0 at order 1).
template <class T>
struct InnerState {
  Primitive<T> inside;
  T scaling;
};

/// Of a cell at a point. At `order` 1 the state of the cell.
template <class T>
InnerState<T> inner_state(const Subdomain& domain, const FlowField<T>& flow,
                          const Reconstruction<T>& reconstruction, Index cell, const Vec3& point, int order) {
  const Primitive<T>& w = flow[cell];
  if (order == 1) return {w, T(0)};
  const auto carried = extrapolated(w, reconstruction[cell], point - domain.center[cell]);
  const T scaling = positivity_scaling(carried, w);
  if (scaling < T(1)) return {w + scaling * (carried - w), scaling};
  return {carried, T(1)};
}

/// Of a boundary face.
template <class T>
InnerState<T> inner_state(const Subdomain& domain, const FlowField<T>& flow,
                          const Reconstruction<T>& reconstruction, std::size_t face, int order) {
  return inner_state(domain, flow, reconstruction, domain.boundary_faces[face].cell,
                     domain.boundary_center[face], order);
}

}  // namespace alphadot
