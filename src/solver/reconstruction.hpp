// Cell gradients, limited, and the states they give on faces.
#pragma once

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

  /// Fills the gradients of owned cells from a flow whose ghosts are current. Two passes: moments and extrema
  /// of the points, then gradient and limiter of the cells (about 450 flops a cell).
  void update(const FlowField<T>& flow);
  /// Brings the gradients of face ghosts up to date.
  void start_exchange() { gradients_.start_exchange(); }
  void finish_exchange() { gradients_.finish_exchange(); }

  const Gradient<T>& operator[](Index cell) const { return gradients_[cell]; }
  std::size_t bytes() const { return gradients_.bytes() + points_.size() * sizeof(PointSums); }
  const HaloExchange<Gradient<T>>& halo() const { return gradients_.halo(); }

 private:
  /// Sums over the cells j around a point v: values, values times (c_j - x_v), and extrema.
  struct PointSums {
    Primitive<T> value;
    Gradient<T> moment;
    Primitive<T> minimum, maximum;
  };

  void gather_points(const FlowField<T>& flow);
  void fit_cells(const FlowField<T>& flow);

  const Discretization& discretization_;
  CellField<Gradient<T>> gradients_;
  std::vector<PointSums> points_;  // [owned_points]
};

}  // namespace alphadot
