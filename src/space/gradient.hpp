// Cell gradients, linear in the flow: sums over the cells around each point, then a fit in each cell.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <type_traits>
#include <vector>

#include "core/changes.hpp"
#include "core/four.hpp"
#include "core/prefetch.hpp"
#include "space/corner_slope.hpp"
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

/// Reconstructed change of variable i at an offset.
template <class T>
T change_at(const Gradient<T>& gradient, const Vec3& offset, int i) {
  return offset.x * gradient.along[0][i] + offset.y * gradient.along[1][i] + offset.z * gradient.along[2][i];
}

/// Extrema of a flow around a point, variable by variable; changes of a flow have none.
template <class T>
struct Extrema {
  Primitive<T> minimum, maximum;
};
struct NoExtrema {};
/// Over the cells j around a point v, variable by variable: sums of q_j times (c_j - x_v, 1); and extrema.
template <class T>
struct PointSums : std::conditional_t<is_change<T>, NoExtrema, Extrema<T>> {
  std::array<Four<T>, 5> moments;
};

/// Vectors from the corners of a cell to its centroid.
using Offsets = std::array<Vec3, 4>;
/// Of one cell, in the unit of the mesh.
inline Offsets offsets_of(const Subdomain& domain, Index cell) {
  Offsets out;
  for (std::size_t corner = 0; corner < out.size(); ++corner)
    out[corner] = domain.center[cell] - domain.points[domain.cell_points[cell][corner]];
  return out;
}

/// Smallest and largest values of each variable that were seen.
template <class T>
class RunningExtrema {
 public:
  explicit RunningExtrema(const Primitive<T>& first) : minimum_(first), maximum_(first) {}
  void widen(const Primitive<T>& w) {
    for (int i = 0; i < 5; ++i) {
      minimum_[i] = w[i] < minimum_[i] ? w[i] : minimum_[i];
      maximum_[i] = w[i] > maximum_[i] ? w[i] : maximum_[i];
    }
  }
  const Primitive<T>& minimum() const { return minimum_; }
  const Primitive<T>& maximum() const { return maximum_; }

 private:
  Primitive<T> minimum_, maximum_;
};

/// Of plain numbers: four variables in a vector register, the last one by itself.
template <>
class RunningExtrema<Real> {
 public:
  explicit RunningExtrema(const Primitive<Real>& first)
      : minima_(load_four(first.v)), maxima_(minima_), minimum_(first[4]), maximum_(first[4]) {}
  void widen(const Primitive<Real>& w) {
    const auto four_of_them = load_four(w.v);
    minima_ = alphadot::minimum(minima_, four_of_them);
    maxima_ = alphadot::maximum(maxima_, four_of_them);
    minimum_ = std::min(minimum_, w[4]);
    maximum_ = std::max(maximum_, w[4]);
  }
  Primitive<Real> minimum() const { return joined(minima_, minimum_); }
  Primitive<Real> maximum() const { return joined(maxima_, maximum_); }

 private:
  static Primitive<Real> joined(const FourReals& four_of_them, Real last) {
    Primitive<Real> out;
    store_four(four_of_them, out.v);
    out[4] = last;
    return out;
  }
  FourReals minima_, maxima_;
  Real minimum_, maximum_;
};

/// Those of the points [begin, end), from the flow in the cells around them.
template <class T>
void gather_points(const Discretization& discretization, const FlowField<T>& flow, Index begin, Index end,
                   std::span<PointSums<T>> points) {
  constexpr Index points_ahead = 4;  // that the memory is asked for
  const Subdomain& domain = discretization.domain();
  for (Index point = begin; point < end; ++point) {
    if (const Index ahead = point + points_ahead; ahead < end)
      for (const Index cell : domain.point_cells[ahead]) {
        prefetch(flow[cell]);
        prefetch(domain.center[cell]);
      }
    const auto cells = domain.point_cells[point];
    const Vec3 x = domain.points[point];
    PointSums<T> sums{};
    RunningExtrema<T> extrema(flow[cells[0]]);
    for (const Index cell : cells) {
      const Primitive<T>& w = flow[cell];
      const Vec3 d = domain.center[cell] - x;
      const FourReals from_point{d.x, d.y, d.z, 1};
      for (std::size_t i = 0; i < 5; ++i) sums.moments[i] += times(from_point, w.v[i]);
      if constexpr (!is_change<T>) extrema.widen(w);
    }
    if constexpr (!is_change<T>) {
      sums.minimum = extrema.minimum();
      sums.maximum = extrema.maximum();
    }
    points[static_cast<std::size_t>(point)] = sums;
  }
}

/// Weighted least squares over the cells around the corners, each once for every corner that it shares.
template <class T>
Gradient<T> least_squares(const Discretization& discretization, std::span<const PointSums<T>> points,
                          Index cell, const Offsets& offsets, const Primitive<T>& w) {
  const auto& corners = discretization.domain().cell_points[cell];
  std::array<Four<T>, 5> right{};  // the last number of each is without meaning
  FourReals offset{};
  for (std::size_t corner = 0; corner < 4; ++corner) {
    const PointSums<T>& sums = points[corners[corner]];
    const PointMoments& moments = discretization.point_moments(corners[corner]);
    const FourReals from_corner{offsets[corner].x, offsets[corner].y, offsets[corner].z, 0};
    offset += load_four(&moments.first.x) - moments.count * from_corner;
    for (std::size_t i = 0; i < 5; ++i) {
      right[i] += sums.moments[i];
      right[i] -= times(from_corner, T(sums.moments[i][3]));
    }
  }
  const Symmetric3& a = discretization.inverse_fit(cell);
  Gradient<T> out;
  for (int i = 0; i < 5; ++i) {
    right[i] -= times(offset, w[i]);
    const T bx = right[i][0], by = right[i][1], bz = right[i][2];
    out.along[0][i] = a.xx * bx + a.xy * by + a.xz * bz;
    out.along[1][i] = a.xy * bx + a.yy * by + a.yz * bz;
    out.along[2][i] = a.xz * bx + a.yz * by + a.zz * bz;
  }
  return out;
}

/// From values at the corners, which are interpolated exactly to second order (Rausch, Batina & Yang 1992).
template <class T>
Gradient<T> green_gauss(const Discretization& discretization, std::span<const PointSums<T>> points,
                        Index cell) {
  const Subdomain& domain = discretization.domain();
  const auto& corners = domain.cell_points[cell];
  Gradient<T> out{};
  if (discretization.is_flat(cell)) return out;
  for (std::size_t corner = 0; corner < 4; ++corner) {
    const PointSums<T>& sums = points[corners[corner]];
    const PointMoments& moments = discretization.point_moments(corners[corner]);
    const Real inverse_weight = 1 / (moments.count + dot(moments.lambda, moments.first));
    const Vec3 slope = corner_slope(domain, cell, corner);
    for (int i = 0; i < 5; ++i) {
      const Four<T>& sum = sums.moments[i];
      const T value = inverse_weight * (sum[3] + moments.lambda.x * sum[0] + moments.lambda.y * sum[1] +
                                        moments.lambda.z * sum[2]);
      for (int axis = 0; axis < 3; ++axis) out.along[axis][i] += slope[axis] * value;
    }
  }
  return out;
}

/// As the case asks for it.
template <class T>
Gradient<T> unlimited_gradient(const Discretization& discretization, std::span<const PointSums<T>> points,
                               Index cell, const Offsets& offsets, const Primitive<T>& w) {
  const bool by_least_squares = discretization.space().gradient == GradientKind::least_squares;
  return by_least_squares ? least_squares(discretization, points, cell, offsets, w)
                          : green_gauss(discretization, points, cell);
}

}  // namespace alphadot
