#include "space/reconstruction.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <type_traits>

#include "core/dual.hpp"
#include "core/prefetch.hpp"
#include "space/corner_slope.hpp"
#include "space/limiter.hpp"

namespace alphadot {

namespace {
constexpr Index points_ahead = 4, cells_ahead = 8;  // that the memory is asked for

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

}  // namespace

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
  if (!frozen_) positivity_cells_ = 0;
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
    points_[point] = sums;
  }
}

template <class T>
Gradient<T> Reconstruction<T>::least_squares(Index cell, const Offsets& offsets,
                                             const Primitive<T>& w) const {
  const auto& corners = discretization_.domain().cell_points[cell];
  std::array<Four<T>, 5> right{};  // the last number of each is without meaning
  FourReals offset{};
  for (std::size_t corner = 0; corner < 4; ++corner) {
    const PointSums& sums = points_[corners[corner]];
    const PointMoments& moments = discretization_.point_moments(corners[corner]);
    const FourReals from_corner{offsets[corner].x, offsets[corner].y, offsets[corner].z, 0};
    offset += load_four(&moments.first.x) - moments.count * from_corner;
    for (std::size_t i = 0; i < 5; ++i) {
      right[i] += sums.moments[i];
      right[i] -= times(from_corner, T(sums.moments[i][3]));
    }
  }
  const Symmetric3& a = discretization_.inverse_fit(cell);
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

namespace {

template <LimiterKind limiter, class T, class E>
T limited_share(const T& delta, const T& bound, const E& epsilon2) {
  if constexpr (limiter == LimiterKind::barth_jespersen)
    return barth_jespersen(delta, bound);
  else
    return venkatakrishnan(delta, bound, epsilon2);
}

/// Reconstructed change of variable i at an offset.
template <class T>
T change_at(const Gradient<T>& gradient, const Vec3& offset, int i) {
  return offset.x * gradient.along[0][i] + offset.y * gradient.along[1][i] + offset.z * gradient.along[2][i];
}

constexpr bool must_be_positive(int variable) {
  return variable == 0 || variable == 4;
}

/// Smallest ratio of a face's value to the cell's, from the changes `delta` that the whole gradient makes
/// where the limiter looks.
template <LimiterKind limiter>
Real lowest_ratio(const FourReals& delta, Real factor, Real value) {
  constexpr Real to_faces = to_face / reach(limiter);
  return 1 + factor * smallest_of(to_faces * delta) / value;
}

/// Square of the changes that pass the limiter: a share of the cell's own density, speed of sound and
/// pressure.
template <class S>
Five<S> passed_changes(const Discretization& discretization, const S& density, const S& pressure) {
  const Real share = discretization.space().limiter_threshold, share2 = share * share;
  const S sound2 = discretization.gamma() * pressure / density;
  return {{share2 * density * density, share2 * sound2, share2 * sound2, share2 * sound2,
           share2 * pressure * pressure}};
}

}  // namespace

template <class T>
template <LimiterKind limiter>
Primitive<T> Reconstruction<T>::limiter_factors(Index cell, const Offsets& offsets, const Primitive<T>& w,
                                                const Gradient<T>& gradient) {
  const auto& corners = discretization_.domain().cell_points[cell];
  const Five<Real> epsilon2 = passed_changes(discretization_, value_of(w[0]), value_of(w[4]));
  // All corners at once, a variable after the other.
  std::array<const PointSums*, 4> points;
  for (std::size_t corner = 0; corner < 4; ++corner) points[corner] = &points_[corners[corner]];
  const FourReals x = reach(limiter) * FourReals{offsets[0].x, offsets[1].x, offsets[2].x, offsets[3].x},
                  y = reach(limiter) * FourReals{offsets[0].y, offsets[1].y, offsets[2].y, offsets[3].y},
                  z = reach(limiter) * FourReals{offsets[0].z, offsets[1].z, offsets[2].z, offsets[3].z};
  Primitive<T> out;
  Real lowest = 1;
  for (int i = 0; i < 5; ++i) {
    FourReals low{}, high{};
    for (std::size_t corner = 0; corner < 4; ++corner) {
      low[corner] = value_of(points[corner]->minimum[i]);
      high[corner] = value_of(points[corner]->maximum[i]);
    }
    if (!is_at_corners(limiter)) {
      low = four(smallest_of(low));
      high = four(largest_of(high));
    }
    const FourReals delta = x * value_of(gradient.along[0][i]) + y * value_of(gradient.along[1][i]) +
                            z * value_of(gradient.along[2][i]);
    const FourReals bound = (delta > 0 ? high : low) - value_of(w[i]);
    out[i] = std::min(smallest_of(limited_share<limiter>(delta, bound, four(epsilon2[i]))), Real{1});
    if (must_be_positive(i))
      lowest = std::min(lowest, lowest_ratio<limiter>(delta, value_of(out[i]), value_of(w[i])));
  }
  const Real share = positive_share(lowest);
  if (share < 1) ++positivity_cells_;
  return share * out;
}

template <class T>
template <LimiterKind limiter>
LimiterSlope Reconstruction<T>::limiter_slope(Index cell, const FlowField<T>& flow) const {
  const Subdomain& domain = discretization_.domain();
  const auto& corners = domain.cell_points[cell];
  const Offsets offsets = offsets_of(cell);
  const Primitive<Real>& w = flow[cell];
  Dual<2> density = w[0], pressure = w[4];
  density.d[0] = pressure.d[1] = 1;
  const Five<Dual<2>> epsilon2 = passed_changes(discretization_, density, pressure);
  LimiterSlope out{{{1, 1, 1, 1, 1}}, unlimited(cell, offsets, w), {}, {}, {}, {}, {}, {}};
  out.extremum.fill(cell);
  if (frozen_) {
    for (int i = 0; i < 5; ++i) out.factor[i] = factors_[static_cast<std::size_t>(cell)][i];
    return out;
  }
  for (int i = 0; i < 5; ++i) {
    const auto entry = static_cast<std::size_t>(i);
    for (std::size_t corner = 0; corner < offsets.size(); ++corner) {
      Dual<3> delta = change_at(out.gradient, reach(limiter) * offsets[corner], i);
      const auto extremum_of = [&](Index point) {
        return delta.v > 0 ? points_[point].maximum[i] : points_[point].minimum[i];
      };
      Index at = corners[corner];
      for (const Index point : corners)
        if (!is_at_corners(limiter) &&
            (delta.v > 0 ? extremum_of(point) > extremum_of(at) : extremum_of(point) < extremum_of(at)))
          at = point;
      Dual<3> bound = extremum_of(at) - w[i], passed = epsilon2[i].v;
      delta.d[0] = bound.d[1] = passed.d[2] = 1;
      const Dual<3> factor = limited_share<limiter>(delta, bound, passed);
      if (!(factor.v < out.factor[i])) continue;
      out.factor[i] = factor.v;
      out.by_delta[i] = factor.d[0];
      out.by_bound[i] = factor.d[1];
      out.by_density[i] = factor.d[2] * epsilon2[i].d[0];
      out.by_pressure[i] = factor.d[2] * epsilon2[i].d[1];
      out.corner[entry] = static_cast<std::uint8_t>(corner);
      const Real side = delta.v > 0 ? 1 : -1;
      out.extremum[entry] = *std::ranges::max_element(domain.point_cells[at], {},
                                                      [&](Index other) { return side * flow[other][i]; });
    }
  }
  Real lowest = 1;
  for (int i = 0; i < 5; ++i) {
    if (!must_be_positive(i)) continue;
    FourReals delta;
    for (std::size_t corner = 0; corner < offsets.size(); ++corner)
      delta[corner] = change_at(out.gradient, reach(limiter) * offsets[corner], i);
    lowest = std::min(lowest, lowest_ratio<limiter>(delta, out.factor[i], w[i]));
  }
  const Real share = positive_share(lowest);  // held
  for (auto* numbers : {&out.factor, &out.by_delta, &out.by_bound, &out.by_density, &out.by_pressure})
    *numbers = share * *numbers;
  return out;
}

template <class T>
std::vector<LimiterSlope> Reconstruction<T>::limiter_slopes(
    const FlowField<T>& flow) const requires std::is_same_v<T, Real> {
  const auto slopes = [&]<LimiterKind limiter>() {
    std::vector<LimiterSlope> out(static_cast<std::size_t>(discretization_.domain().owned_cells));
    if constexpr (!is_change<T>)  // Clang before 16 also instantiates what the constraint excludes
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
void Reconstruction<T>::follow_limiter(Index cell, const FlowField<T>& flow, const Offsets& offsets,
                                       Gradient<T>& gradient) const {
  const LimiterSlope& slope = slopes_[static_cast<std::size_t>(cell)];
  for (int i = 0; i < 5; ++i) {
    const auto entry = static_cast<std::size_t>(i);
    const T delta = change_at(gradient, reach(limiter) * offsets[slope.corner[entry]], i);
    const T bound = flow[slope.extremum[entry]][i] - flow[cell][i];
    const T factor = slope.by_delta[i] * delta + slope.by_bound[i] * bound +
                     slope.by_density[i] * flow[cell][0] + slope.by_pressure[i] * flow[cell][4];
    for (int axis = 0; axis < 3; ++axis)
      gradient.along[axis][i] =
          slope.factor[i] * gradient.along[axis][i] + slope.gradient.along[axis][i] * factor;
  }
}

template <class T>
typename Reconstruction<T>::Offsets Reconstruction<T>::offsets_of(Index cell) const {
  const Subdomain& domain = discretization_.domain();
  Offsets out;
  for (std::size_t corner = 0; corner < out.size(); ++corner)
    out[corner] = domain.center[cell] - domain.points[domain.cell_points[cell][corner]];
  return out;
}

template <class T>
Gradient<T> Reconstruction<T>::unlimited(Index cell, const Offsets& offsets, const Primitive<T>& w) const {
  const bool by_least_squares = discretization_.space().gradient == GradientKind::least_squares;
  return by_least_squares ? least_squares(cell, offsets, w) : green_gauss(cell);
}

template <class T>
template <LimiterKind limiter>
[[gnu::flatten]] void Reconstruction<T>::fit_limited(const FlowField<T>& flow, Index begin, Index end) {
  const Subdomain& domain = discretization_.domain();
  for (Index cell = begin; cell < end; ++cell) {
    if (const Index ahead = cell + cells_ahead; ahead < end)
      for (const Index point : domain.cell_points[ahead]) prefetch(points_[point]);
    const Primitive<T>& w = flow[cell];
    const Offsets offsets = offsets_of(cell);
    Gradient<T> gradient = unlimited(cell, offsets, w);
    if constexpr (is_change<T>) {
      if (!slopes_.empty()) follow_limiter<limiter>(cell, flow, offsets, gradient);
    } else if constexpr (limiter != LimiterKind::none) {
      Primitive<T> factor;
      if (frozen_) {
        for (int i = 0; i < 5; ++i) factor[i] = factors_[cell][i];
      } else {
        factor = limiter_factors<limiter>(cell, offsets, w, gradient);
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
