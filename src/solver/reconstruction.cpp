#include "solver/reconstruction.hpp"

#include <algorithm>
#include <cmath>
#include <type_traits>

#include "core/dual.hpp"
#include "solver/limiter.hpp"
#include "solver/prefetch.hpp"

namespace alphadot {

namespace {
constexpr Index points_ahead = 4, cells_ahead = 8;  // that the memory is asked for
}

template <class T>
Reconstruction<T>::Reconstruction(const Discretization& discretization, const Communicator& comm)
    : discretization_(discretization),
      gradients_(discretization.domain(), comm, HaloWidth::faces),
      points_(static_cast<std::size_t>(discretization.domain().owned_points)),
      factors_(discretization.space().freeze_orders > 0
                   ? static_cast<std::size_t>(discretization.domain().owned_cells)
                   : 0) {}

template <class T>
void Reconstruction<T>::update(FlowField<T>& flow) {
  const Subdomain& domain = discretization_.domain();
  gather_points(flow, 0, domain.interior_points);
  fit_cells(flow, 0, domain.interior_cells);
  flow.finish_exchange();
  gather_points(flow, domain.interior_points, domain.owned_points);
  fit_cells(flow, domain.interior_cells, domain.owned_cells);
}

template <class T>
void Reconstruction<T>::fit_cells(const FlowField<T>& flow, Index begin, Index end) {
  switch (discretization_.space().limiter) {
    case LimiterKind::venkatakrishnan:
      return fit_limited<LimiterKind::venkatakrishnan>(flow, begin, end);
    case LimiterKind::mlp_u2:
      return fit_limited<LimiterKind::mlp_u2>(flow, begin, end);
    case LimiterKind::barth_jespersen:
      return fit_limited<LimiterKind::barth_jespersen>(flow, begin, end);
    case LimiterKind::none:
      return fit_limited<LimiterKind::none>(flow, begin, end);
  }
}

template <class T>
void Reconstruction<T>::gather_points(const FlowField<T>& flow, Index begin, Index end) {
  const Subdomain& domain = discretization_.domain();
  for (Index point = begin; point < end; ++point) {
    if (const Index ahead = point + points_ahead; ahead < end)
      for (const Index cell : domain.point_cells[ahead]) {
        prefetch(flow[cell]);
        prefetch(domain.center[cell]);
      }
    const auto cells = domain.point_cells[point];
    const Vec3 x = domain.points[point];
    PointSums sums{};
    sums.minimum = sums.maximum = flow[cells[0]];
    for (const Index cell : cells) {
      const Primitive<T>& w = flow[cell];
      const Vec3 d = domain.center[cell] - x;
      for (int i = 0; i < 5; ++i) {
        sums.value[i] += w[i];
        sums.moment.along[0][i] += d.x * w[i];
        sums.moment.along[1][i] += d.y * w[i];
        sums.moment.along[2][i] += d.z * w[i];
        sums.minimum[i] = w[i] < sums.minimum[i] ? w[i] : sums.minimum[i];
        sums.maximum[i] = w[i] > sums.maximum[i] ? w[i] : sums.maximum[i];
      }
    }
    points_[point] = sums;
  }
}

template <class T>
Gradient<T> Reconstruction<T>::least_squares(Index cell, const Arms& arms, const Primitive<T>& w) const {
  const auto& corners = discretization_.domain().cell_points[cell];
  Gradient<T> right{};
  Vec3 offset{};
  for (std::size_t corner = 0; corner < 4; ++corner) {
    const PointSums& sums = points_[corners[corner]];
    const PointMoments& moments = discretization_.point_moments(corners[corner]);
    offset += moments.first - moments.count * arms[corner];
    for (int axis = 0; axis < 3; ++axis)
      for (int i = 0; i < 5; ++i)
        right.along[axis][i] += sums.moment.along[axis][i] - arms[corner][axis] * sums.value[i];
  }
  const Symmetric3& a = discretization_.inverse_fit(cell);
  Gradient<T> out;
  for (int i = 0; i < 5; ++i) {
    const T bx = right.along[0][i] - offset.x * w[i], by = right.along[1][i] - offset.y * w[i],
            bz = right.along[2][i] - offset.z * w[i];
    out.along[0][i] = a.xx * bx + a.xy * by + a.xz * bz;
    out.along[1][i] = a.xy * bx + a.yy * by + a.yz * bz;
    out.along[2][i] = a.xz * bx + a.yz * by + a.zz * bz;
  }
  return out;
}

template <class T>
Gradient<T> Reconstruction<T>::green_gauss(Index cell) const {
  const Subdomain& domain = discretization_.domain();
  const auto& corners = domain.cell_points[cell];
  Gradient<T> out{};
  if (discretization_.is_flat(cell)) return out;
  for (std::size_t corner = 0; corner < 4; ++corner) {
    const PointSums& sums = points_[corners[corner]];
    const PointMoments& moments = discretization_.point_moments(corners[corner]);
    const Real inverse_weight = 1 / (moments.count + dot(moments.lambda, moments.first));
    // Over a tetrahedron the surface integral of values linear on its faces is that of the linear
    // interpolant, whose gradient is a sum over corners of value times the inward area of the opposite face
    // over 3 V.
    const Vec3& a = domain.points[corners[(corner + 1) % 4]];
    const Vec3& b = domain.points[corners[(corner + 2) % 4]];
    const Vec3& c = domain.points[corners[(corner + 3) % 4]];
    const Vec3 area = cross(b - a, c - a);
    const Vec3 slope = (1 / dot(domain.points[corners[corner]] - a, area)) * area;
    for (int i = 0; i < 5; ++i) {
      const T value = inverse_weight * (sums.value[i] + moments.lambda.x * sums.moment.along[0][i] +
                                        moments.lambda.y * sums.moment.along[1][i] +
                                        moments.lambda.z * sums.moment.along[2][i]);
      for (int axis = 0; axis < 3; ++axis) out.along[axis][i] += slope[axis] * value;
    }
  }
  return out;
}

namespace {

template <LimiterKind limiter, class T>
T limited_share(const T& delta, const T& room, Real epsilon2) {
  if constexpr (limiter == LimiterKind::barth_jespersen)
    return barth_jespersen(delta, room);
  else
    return venkatakrishnan(delta, room, epsilon2);
}

/// Reconstructed change of variable i at an offset.
template <class T>
T change_at(const Gradient<T>& gradient, const Vec3& offset, int i) {
  return offset.x * gradient.along[0][i] + offset.y * gradient.along[1][i] + offset.z * gradient.along[2][i];
}

Gradient<Real> values_of(const Gradient<Real>& gradient) {
  return gradient;
}
template <int N>
Gradient<Real> values_of(const Gradient<Dual<N>>& gradient) {
  Gradient<Real> out;
  for (int axis = 0; axis < 3; ++axis)
    for (int i = 0; i < 5; ++i) out.along[axis][i] = gradient.along[axis][i].v;
  return out;
}

}  // namespace

template <class T>
template <LimiterKind limiter>
Primitive<T> Reconstruction<T>::limiter_factors(Index cell, const Arms& arms, const Primitive<T>& w,
                                                const Gradient<T>& gradient) const {
  const Subdomain& domain = discretization_.domain();
  const auto& corners = domain.cell_points[cell];
  // (K h)^3 with h^3 = 6 V (a cube's corner); scales of density, speed and pressure: 1, 1 and 1/gamma.
  const Real gamma = discretization_.gamma();
  const Real k = discretization_.space().limiter_k;
  const Real epsilon2 = k * k * k * 6 * domain.volume[cell];
  const Real scaled[5] = {epsilon2, epsilon2, epsilon2, epsilon2, epsilon2 / (gamma * gamma)};
  // MLP looks at each corner and its own extrema; the others at the face opposite, a third of the arm beyond
  // the centroid, and the extrema of all corners.
  constexpr bool at_corners = limiter == LimiterKind::mlp_u2;
  constexpr Real reach = at_corners ? -1.0 : 1.0 / 3;
  std::array<const PointSums*, 4> points;
  for (std::size_t corner = 0; corner < 4; ++corner) points[corner] = &points_[corners[corner]];
  // The smallest factor is found among plain numbers; it alone is differentiated.
  using Numbers = std::array<Real, 5>;
  using Corners = std::array<std::size_t, 5>;
  Numbers minimum, maximum, smallest;
  Corners lowest{}, highest{}, tightest;  // corners that hold the extrema, and that with the smallest factor
  smallest.fill(1);
  tightest.fill(arms.size());
  const auto begin_with = [&](std::size_t corner) {
    for (int i = 0; i < 5; ++i) {
      minimum[i] = value_of(points[corner]->minimum[i]);
      maximum[i] = value_of(points[corner]->maximum[i]);
    }
    lowest.fill(corner);
    highest.fill(corner);
  };
  begin_with(0);
  for (std::size_t corner = 1; corner < 4 && !at_corners; ++corner)
    for (int i = 0; i < 5; ++i) {
      const Real low = value_of(points[corner]->minimum[i]), high = value_of(points[corner]->maximum[i]);
      lowest[i] = low < minimum[i] ? corner : lowest[i];
      minimum[i] = std::min(low, minimum[i]);
      highest[i] = high > maximum[i] ? corner : highest[i];
      maximum[i] = std::max(high, maximum[i]);
    }
  const Gradient<Real> slope = values_of(gradient);
  for (std::size_t corner = 0; corner < arms.size(); ++corner) {
    const Vec3 offset = reach * arms[corner];
    if (at_corners) begin_with(corner);
    for (int i = 0; i < 5; ++i) {
      const Real delta = change_at(slope, offset, i);
      const Real room = (delta > 0 ? maximum[i] : minimum[i]) - value_of(w[i]);
      const Real factor = limited_share<limiter>(delta, room, scaled[i]);
      tightest[i] = factor < smallest[i] ? corner : tightest[i];
      smallest[i] = std::min(factor, smallest[i]);
    }
  }
  Primitive<T> out;
  for (int i = 0; i < 5; ++i) {
    out[i] = smallest[i];
    if constexpr (!std::is_same_v<T, Real>)
      if (const std::size_t corner = tightest[i]; corner < arms.size()) {
        const T delta = change_at(gradient, reach * arms[corner], i);
        const T& extremum = value_of(delta) > 0 ? points[at_corners ? corner : highest[i]]->maximum[i]
                                                : points[at_corners ? corner : lowest[i]]->minimum[i];
        out[i] = limited_share<limiter>(delta, extremum - w[i], scaled[i]);
      }
  }
  return out;
}

template <class T>
template <LimiterKind limiter>
void Reconstruction<T>::fit_limited(const FlowField<T>& flow, Index begin, Index end) {
  const Subdomain& domain = discretization_.domain();
  const bool by_least_squares = discretization_.space().gradient == GradientKind::least_squares;
  for (Index cell = begin; cell < end; ++cell) {
    if (const Index ahead = cell + cells_ahead; ahead < end)
      for (const Index point : domain.cell_points[ahead]) prefetch(points_[point]);
    const Primitive<T>& w = flow[cell];
    Arms arms;
    for (std::size_t corner = 0; corner < 4; ++corner)
      arms[corner] = domain.center[cell] - domain.points[domain.cell_points[cell][corner]];
    Gradient<T> gradient = by_least_squares ? least_squares(cell, arms, w) : green_gauss(cell);
    if constexpr (limiter != LimiterKind::none) {
      Primitive<T> factor;
      if (frozen_) {
        for (int i = 0; i < 5; ++i) factor[i] = factors_[cell][i];
      } else {
        factor = limiter_factors<limiter>(cell, arms, w, gradient);
        if (!factors_.empty())
          for (int i = 0; i < 5; ++i) factors_[cell][i] = static_cast<float>(value_of(factor[i]));
      }
      for (int axis = 0; axis < 3; ++axis)
        for (int i = 0; i < 5; ++i) gradient.along[axis][i] = factor[i] * gradient.along[axis][i];
    }
    gradients_[cell] = gradient;
  }
}

template <class T>
std::size_t Reconstruction<T>::bytes() const {
  return gradients_.bytes() + points_.size() * sizeof(PointSums) + factors_.size() * sizeof(factors_[0]);
}

template class Reconstruction<Real>;
template class Reconstruction<Dual<1>>;
template class Reconstruction<Dual<2>>;
template class Reconstruction<Dual<3>>;

}  // namespace alphadot
