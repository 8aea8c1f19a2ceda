#include "solver/reconstruction.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
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
    if constexpr (!is_change<T>) sums.minimum = sums.maximum = flow[cells[0]];
    for (const Index cell : cells) {
      const Primitive<T>& w = flow[cell];
      const Vec3 d = domain.center[cell] - x;
      for (int i = 0; i < 5; ++i) {
        sums.value[i] += w[i];
        sums.moment.along[0][i] += d.x * w[i];
        sums.moment.along[1][i] += d.y * w[i];
        sums.moment.along[2][i] += d.z * w[i];
        if constexpr (!is_change<T>) {
          sums.minimum[i] = w[i] < sums.minimum[i] ? w[i] : sums.minimum[i];
          sums.maximum[i] = w[i] > sums.maximum[i] ? w[i] : sums.maximum[i];
        }
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

/// MLP looks at each corner and its own extrema; the others at the face opposite, a third of the arm beyond
/// the centroid, and the extrema of all corners.
constexpr bool is_at_corners(LimiterKind limiter) {
  return limiter == LimiterKind::mlp_u2;
}
constexpr Real reach(LimiterKind limiter) {
  return is_at_corners(limiter) ? -1.0 : 1.0 / 3;
}

/// (K h)^3 with h^3 = 6 V (a cube's corner), times the square of the variable's scale: density 1, speed 1,
/// pressure 1/gamma.
Five<Real> passed_wiggles(const Discretization& discretization, Index cell) {
  const Real gamma = discretization.gamma(), k = discretization.space().limiter_k;
  const Real epsilon2 = k * k * k * 6 * discretization.domain().volume[cell];
  return {{epsilon2, epsilon2, epsilon2, epsilon2, epsilon2 / (gamma * gamma)}};
}

}  // namespace

template <class T>
template <LimiterKind limiter>
Primitive<T> Reconstruction<T>::limiter_factors(Index cell, const Arms& arms, const Primitive<T>& w,
                                                const Gradient<T>& gradient) const {
  const auto& corners = discretization_.domain().cell_points[cell];
  const Five<Real> epsilon2 = passed_wiggles(discretization_, cell);
  Primitive<T> minimum, maximum, smallest{{1, 1, 1, 1, 1}};
  const auto begin_with = [&](std::size_t corner) {
    minimum = points_[corners[corner]].minimum;
    maximum = points_[corners[corner]].maximum;
  };
  begin_with(0);
  for (std::size_t corner = 1; corner < 4 && !is_at_corners(limiter); ++corner)
    for (int i = 0; i < 5; ++i) {
      const T low = points_[corners[corner]].minimum[i], high = points_[corners[corner]].maximum[i];
      minimum[i] = low < minimum[i] ? low : minimum[i];
      maximum[i] = high > maximum[i] ? high : maximum[i];
    }
  for (std::size_t corner = 0; corner < arms.size(); ++corner) {
    const Vec3 offset = reach(limiter) * arms[corner];
    if (is_at_corners(limiter)) begin_with(corner);
    for (int i = 0; i < 5; ++i) {
      const T delta = change_at(gradient, offset, i);
      const T room = (delta > T(0) ? maximum[i] : minimum[i]) - w[i];
      const T factor = limited_share<limiter>(delta, room, epsilon2[i]);
      smallest[i] = factor < smallest[i] ? factor : smallest[i];
    }
  }
  return smallest;
}

template <class T>
template <LimiterKind limiter>
LimiterSlope Reconstruction<T>::limiter_slope(Index cell, const FlowField<T>& flow) const {
  const Subdomain& domain = discretization_.domain();
  const auto& corners = domain.cell_points[cell];
  const Five<Real> epsilon2 = passed_wiggles(discretization_, cell);
  const Arms arms = arms_of(cell);
  const Primitive<Real>& w = flow[cell];
  LimiterSlope out{{{1, 1, 1, 1, 1}}, unlimited(cell, arms, w), {}, {}, {}, {}};
  out.extremum.fill(cell);
  if (frozen_) {
    for (int i = 0; i < 5; ++i) out.factor[i] = factors_[static_cast<std::size_t>(cell)][i];
    return out;
  }
  for (int i = 0; i < 5; ++i) {
    const auto entry = static_cast<std::size_t>(i);
    for (std::size_t corner = 0; corner < arms.size(); ++corner) {
      Dual<2> delta = change_at(out.gradient, reach(limiter) * arms[corner], i);
      const auto extremum_of = [&](Index point) {
        return delta.v > 0 ? points_[point].maximum[i] : points_[point].minimum[i];
      };
      Index at = corners[corner];
      for (const Index point : corners)
        if (!is_at_corners(limiter) &&
            (delta.v > 0 ? extremum_of(point) > extremum_of(at) : extremum_of(point) < extremum_of(at)))
          at = point;
      Dual<2> room = extremum_of(at) - w[i];
      delta.d[0] = 1;
      room.d[1] = 1;
      const Dual<2> factor = limited_share<limiter>(delta, room, epsilon2[i]);
      if (!(factor.v < out.factor[i])) continue;
      out.factor[i] = factor.v;
      out.by_delta[i] = factor.d[0];
      out.by_room[i] = factor.d[1];
      out.corner[entry] = static_cast<std::uint8_t>(corner);
      const Real side = delta.v > 0 ? 1 : -1;
      out.extremum[entry] = *std::ranges::max_element(domain.point_cells[at], {},
                                                      [&](Index other) { return side * flow[other][i]; });
    }
  }
  return out;
}

template <class T>
std::vector<LimiterSlope> Reconstruction<T>::limiter_slopes(
    const FlowField<T>& flow) const requires std::is_same_v<T, Real> {
  const auto slopes = [&]<LimiterKind limiter>() {
    std::vector<LimiterSlope> out(static_cast<std::size_t>(discretization_.domain().owned_cells));
    for (std::size_t cell = 0; cell < out.size(); ++cell)
      out[cell] = limiter_slope<limiter>(static_cast<Index>(cell), flow);
    return out;
  };
  switch (discretization_.space().limiter) {
    case LimiterKind::venkatakrishnan:
      return slopes.template operator()<LimiterKind::venkatakrishnan>();
    case LimiterKind::mlp_u2:
      return slopes.template operator()<LimiterKind::mlp_u2>();
    case LimiterKind::barth_jespersen:
      return slopes.template operator()<LimiterKind::barth_jespersen>();
    case LimiterKind::none:
      break;
  }
  return {};
}

template <class T>
template <LimiterKind limiter>
void Reconstruction<T>::follow_limiter(Index cell, const FlowField<T>& flow, const Arms& arms,
                                       Gradient<T>& gradient) const {
  const LimiterSlope& slope = slopes_[static_cast<std::size_t>(cell)];
  for (int i = 0; i < 5; ++i) {
    const auto entry = static_cast<std::size_t>(i);
    const T delta = change_at(gradient, reach(limiter) * arms[slope.corner[entry]], i);
    const T room = flow[slope.extremum[entry]][i] - flow[cell][i];
    const T factor = slope.by_delta[i] * delta + slope.by_room[i] * room;
    for (int axis = 0; axis < 3; ++axis)
      gradient.along[axis][i] =
          slope.factor[i] * gradient.along[axis][i] + slope.gradient.along[axis][i] * factor;
  }
}

template <class T>
typename Reconstruction<T>::Arms Reconstruction<T>::arms_of(Index cell) const {
  const Subdomain& domain = discretization_.domain();
  Arms out;
  for (std::size_t corner = 0; corner < out.size(); ++corner)
    out[corner] = domain.center[cell] - domain.points[domain.cell_points[cell][corner]];
  return out;
}

template <class T>
Gradient<T> Reconstruction<T>::unlimited(Index cell, const Arms& arms, const Primitive<T>& w) const {
  const bool by_least_squares = discretization_.space().gradient == GradientKind::least_squares;
  return by_least_squares ? least_squares(cell, arms, w) : green_gauss(cell);
}

template <class T>
template <LimiterKind limiter>
void Reconstruction<T>::fit_limited(const FlowField<T>& flow, Index begin, Index end) {
  const Subdomain& domain = discretization_.domain();
  for (Index cell = begin; cell < end; ++cell) {
    if (const Index ahead = cell + cells_ahead; ahead < end)
      for (const Index point : domain.cell_points[ahead]) prefetch(points_[point]);
    const Primitive<T>& w = flow[cell];
    const Arms arms = arms_of(cell);
    Gradient<T> gradient = unlimited(cell, arms, w);
    if constexpr (is_change<T>) {
      if (!slopes_.empty()) follow_limiter<limiter>(cell, flow, arms, gradient);
    } else if constexpr (limiter != LimiterKind::none) {
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
template class Reconstruction<Changes<1>>;
template class Reconstruction<Changes<2>>;
template class Reconstruction<Changes<3>>;

}  // namespace alphadot
