#include "space/reconstruction_transpose.hpp"

#include <algorithm>

#include "core/prefetch.hpp"
#include "space/corner_slope.hpp"
#include "space/limiter.hpp"

namespace alphadot {

namespace {

constexpr Index points_ahead = 2;  // that the memory is asked for

}  // namespace

template <int N>
ReconstructionTranspose<N>::ReconstructionTranspose(const Discretization& discretization,
                                                    const LimiterSlopes& slopes)
    : discretization_(discretization),
      slopes_(slopes),
      gradients_(static_cast<std::size_t>(discretization.domain().owned_cells)) {}

template <int N>
void ReconstructionTranspose<N>::clear() {
  std::ranges::fill(gradients_, Gradient<Changes<N>>{});
}

template <int N>
void ReconstructionTranspose<N>::fit_cells(Index begin, Index end, States states) {
  const bool by_least_squares = discretization_.space().gradient == GradientKind::least_squares;
  for (Index cell = begin; cell < end; ++cell) {
    if (!slopes_.empty()) follow_limiter(cell, states);
    if (by_least_squares) least_squares(cell, states);
  }
}

/// The way there: out = phi g + g0 (by_delta delta + by_bound bound + by_density rho + by_pressure p), with
/// delta = offset . g and bound the difference of the extremum, or the mean of several, and the cell.
template <int N>
void ReconstructionTranspose<N>::follow_limiter(Index cell, States states) {
  const LimiterSlope& slope = slopes_[cell];
  const Real reached = reach(discretization_.space().limiter);
  Gradient<Changes<N>>& gradient = (*this)[cell];
  Primitive<Changes<N>>& state = states[static_cast<std::size_t>(cell)];
  const Offsets offsets = offsets_of(discretization_.domain(), cell);
  for (int i = 0; i < 5; ++i) {
    const auto entry = static_cast<std::size_t>(i);
    const Vec3 of_flow{slope.gradient.along[0][i], slope.gradient.along[1][i], slope.gradient.along[2][i]};
    const Changes<N> factor = change_at(gradient, of_flow, i);
    const Vec3 to_look = reached * offsets[slope.corner[entry]];
    for (int axis = 0; axis < 3; ++axis)
      gradient.along[axis][i] =
          slope.factor[i] * gradient.along[axis][i] + (slope.by_delta[i] * to_look[axis]) * factor;
    const Changes<N> bound = slope.by_bound[i] * factor;
    const auto extrema = slopes_.extrema(slope.extremum[entry]);
    const Changes<N> to_each = (1.0 / static_cast<Real>(extrema.size())) * bound;
    for (const Index other : extrema) states[static_cast<std::size_t>(other)][i] += to_each;
    state[i] -= bound;
    state[0] += slope.by_density[i] * factor;
    state[4] += slope.by_pressure[i] * factor;
  }
}

/// The way there: a^-1 (sum over corners of (moments - offset count) - (sum of their offsets) w).
template <int N>
void ReconstructionTranspose<N>::least_squares(Index cell, States states) {
  const Offsets offsets = offsets_of(discretization_.domain(), cell);
  Vec3 sum;
  for (std::size_t corner = 0; corner < 4; ++corner) {
    const PointMoments& moments =
        discretization_.point_moments(discretization_.domain().cell_points[cell][corner]);
    sum += moments.first - moments.count * offsets[corner];
  }
  const Symmetric3& a = discretization_.inverse_fit(cell);
  Gradient<Changes<N>>& gradient = (*this)[cell];
  for (int i = 0; i < 5; ++i) {
    const Changes<N> x = change_at(gradient, {a.xx, a.xy, a.xz}, i),
                     y = change_at(gradient, {a.xy, a.yy, a.yz}, i),
                     z = change_at(gradient, {a.xz, a.yz, a.zz}, i);
    gradient.along[0][i] = x;
    gradient.along[1][i] = y;
    gradient.along[2][i] = z;
    states[static_cast<std::size_t>(cell)][i] -= sum.x * x + sum.y * y + sum.z * z;
  }
}

template <int N>
[[gnu::flatten]] void ReconstructionTranspose<N>::scatter_points(Index begin, Index end,
                                                                 States states) const {
  const bool by_least_squares = discretization_.space().gradient == GradientKind::least_squares;
  const Subdomain& domain = discretization_.domain();
  for (Index point = begin; point < end; ++point) {
    if (const Index ahead = point + points_ahead; ahead < end)
      for (const Index cell : domain.point_cells[ahead]) {
        prefetch(states[static_cast<std::size_t>(cell)]);
        if (cell < domain.owned_cells) prefetch(gradients_[static_cast<std::size_t>(cell)]);
      }
    if (by_least_squares)
      scatter_moments(point, states);
    else
      scatter_value(point, states);
  }
}

/// The way there: moments of the cells around, of which a cell's fit takes first - (centre - point) count.
template <int N>
void ReconstructionTranspose<N>::scatter_moments(Index point, States states) const {
  const Subdomain& domain = discretization_.domain();
  const Vec3 x = domain.points[point];
  Gradient<Changes<N>> first{};
  Primitive<Changes<N>> count{};
  for (const Index cell : domain.point_cells[point]) {
    if (cell >= domain.owned_cells) continue;
    const auto& right = gradients_[static_cast<std::size_t>(cell)];
    const Vec3 d = domain.center[cell] - x;
    for (int i = 0; i < 5; ++i) {
      for (int axis = 0; axis < 3; ++axis) first.along[axis][i] += right.along[axis][i];
      count[i] -= change_at(right, d, i);
    }
  }
  for (const Index cell : domain.point_cells[point]) {
    const Vec3 d = domain.center[cell] - x;
    auto& state = states[static_cast<std::size_t>(cell)];
    for (int i = 0; i < 5; ++i) state[i] += change_at(first, d, i) + count[i];
  }
}

/// The way there: a weighted mean of the cells around, which a cell's gradient takes times the slope of its
/// corner.
template <int N>
void ReconstructionTranspose<N>::scatter_value(Index point, States states) const {
  const Subdomain& domain = discretization_.domain();
  Primitive<Changes<N>> value{};
  for (const Index cell : domain.point_cells[point]) {
    if (cell >= domain.owned_cells || discretization_.is_flat(cell)) continue;
    const auto& corners = domain.cell_points[cell];
    const auto corner = static_cast<std::size_t>(std::ranges::find(corners, point) - corners.begin());
    const Vec3 slope = corner_slope(domain, cell, corner);
    for (int i = 0; i < 5; ++i) value[i] += change_at(gradients_[static_cast<std::size_t>(cell)], slope, i);
  }
  const PointMoments& moments = discretization_.point_moments(point);
  const Real inverse_weight = 1 / (moments.count + dot(moments.lambda, moments.first));
  for (const Index cell : domain.point_cells[point]) {
    const Real weight =
        inverse_weight * (1 + dot(moments.lambda, domain.center[cell] - domain.points[point]));
    for (int i = 0; i < 5; ++i) states[static_cast<std::size_t>(cell)][i] += weight * value[i];
  }
}

template class ReconstructionTranspose<1>;
template class ReconstructionTranspose<2>;
template class ReconstructionTranspose<3>;

}  // namespace alphadot
