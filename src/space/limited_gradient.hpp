// The limiter in a cell: factors of its gradient, and how they follow a small change of the flow.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "core/dual.hpp"
#include "space/gradient.hpp"
#include "space/limiter.hpp"

namespace alphadot {

/// How the limited gradient of one cell follows a small change of the flow:
///   d(phi g) = phi dg + g (by_delta ddelta + by_bound dbound)
/// in each variable, delta and bound being those of the corner that limits it most (see limiter.hpp).
struct LimiterSlope {
  Primitive<Real> factor;   ///< phi
  Gradient<Real> gradient;  ///< g
  Primitive<Real> by_delta, by_bound;
  Primitive<Real> by_density, by_pressure;  ///< of the cell itself, which set what passes the limiter
  std::array<std::uint8_t, 5> corner;
  std::array<Index, 5> extremum;  ///< the cell whose value gives the bound; of several see LimiterSlopes
};

/// Of every owned cell; none without a limiter. Where several cells give the bound alike, as in a flow that
/// is its own mirror image, the limiter has a kink, and the bound follows their mean: what central
/// differences give.
class LimiterSlopes {
 public:
  LimiterSlopes() = default;
  explicit LimiterSlopes(std::size_t owned_cells) : cells_(owned_cells) {}

  bool empty() const { return cells_.empty(); }
  LimiterSlope& operator[](Index cell) { return cells_[static_cast<std::size_t>(cell)]; }
  const LimiterSlope& operator[](Index cell) const { return cells_[static_cast<std::size_t>(cell)]; }
  auto begin() { return cells_.begin(); }
  auto end() { return cells_.end(); }

  /// The cells whose values give a bound alike, at least one.
  std::span<const Index> extrema(const Index& extremum) const {
    if (extremum >= 0) return {&extremum, 1};
    const auto place = static_cast<std::size_t>(-1 - extremum);
    return std::span(tied_).subspan(place + 1, static_cast<std::size_t>(tied_[place]));
  }
  /// What stands in a slope for so many cells.
  Index extremum_of(std::span<const Index> cells) {
    if (cells.size() == 1) return cells.front();
    const auto place = static_cast<Index>(tied_.size());
    tied_.push_back(static_cast<Index>(cells.size()));
    tied_.insert(tied_.end(), cells.begin(), cells.end());
    return -1 - place;
  }
  std::size_t bytes() const { return cells_.size() * sizeof(LimiterSlope) + tied_.size() * sizeof(Index); }

 private:
  std::vector<LimiterSlope> cells_;  // [owned_cells] or none
  std::vector<Index> tied_;          // of each group their count, then the cells
};

/// The factor phi of a limiter at one corner; arguments as in limiter.hpp.
template <LimiterKind limiter, class T, class E>
T corner_factor(const T& delta, const T& bound, const E& epsilon2) {
  if constexpr (limiter == LimiterKind::barth_jespersen)
    return barth_jespersen(delta, bound);
  else
    return venkatakrishnan(delta, bound, epsilon2);
}

/// Density and pressure.
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

/// Factors of the limiter in one cell, times the share that keeps density and pressure positive; counts the
/// cell in `positivity_cells` when that is less than one.
template <LimiterKind limiter, class T>
Primitive<T> limiter_factors(const Discretization& discretization, std::span<const PointSums<T>> points_of,
                             Index cell, const Offsets& offsets, const Primitive<T>& w,
                             const Gradient<T>& gradient, Index& positivity_cells) {
  const auto& corners = discretization.domain().cell_points[cell];
  const Five<Real> epsilon2 = passed_changes(discretization, value_of(w[0]), value_of(w[4]));
  // All corners at once, a variable after the other.
  std::array<const PointSums<T>*, 4> points;
  for (std::size_t corner = 0; corner < 4; ++corner) points[corner] = &points_of[corners[corner]];
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
    out[i] = std::min(smallest_of(corner_factor<limiter>(delta, bound, four(epsilon2[i]))), Real{1});
    if (must_be_positive(i))
      lowest = std::min(lowest, lowest_ratio<limiter>(delta, value_of(out[i]), value_of(w[i])));
  }
  const Real share = positive_share(lowest);
  if (share < 1) ++positivity_cells;
  return share * out;
}

/// Adds to `tied` the cells around a point whose values are next to nothing off an extremum, the cell itself
/// too, once each.
inline void add_tied(const Subdomain& domain, Index point, const FlowField<Real>& flow, int variable,
                     Real extremum, Real change, std::vector<Index>& tied) {
  constexpr Real next_to_nothing =
      1e-6;  // of the change that is limited: far above what converged flows lack of symmetry
  for (const Index other : domain.point_cells[point])
    if (std::abs(flow[other][variable] - extremum) <= next_to_nothing * change &&
        std::ranges::find(tied, other) == tied.end())
      tied.push_back(other);
}

/// Finds that of one cell; with `held` factors, those and no reaction.
template <LimiterKind limiter>
void find_limiter_slope(const Discretization& discretization, std::span<const PointSums<Real>> points,
                        Index cell, const FlowField<Real>& flow, const Five<float>* held,
                        LimiterSlopes& slopes) {
  const Subdomain& domain = discretization.domain();
  const auto& corners = domain.cell_points[cell];
  const Offsets offsets = offsets_of(domain, cell);
  const Primitive<Real>& w = flow[cell];
  Dual<2> density = w[0], pressure = w[4];
  density.d[0] = pressure.d[1] = 1;
  const Five<Dual<2>> epsilon2 = passed_changes(discretization, density, pressure);
  LimiterSlope& out = slopes[cell];
  out = {{{1, 1, 1, 1, 1}},
         unlimited_gradient(discretization, points, cell, offsets, w),
         {},
         {},
         {},
         {},
         {},
         {}};
  out.extremum.fill(cell);
  if (held) {
    for (int i = 0; i < 5; ++i) out.factor[i] = (*held)[i];
    return;
  }
  std::vector<Index> tied;
  for (int i = 0; i < 5; ++i) {
    const auto entry = static_cast<std::size_t>(i);
    Index bounded_at = corners[0];
    Real extremum = 0, change = 0;
    for (std::size_t corner = 0; corner < offsets.size(); ++corner) {
      Dual<3> delta = change_at(out.gradient, reach(limiter) * offsets[corner], i);
      const auto extremum_of = [&](Index point) {
        return delta.v > 0 ? points[point].maximum[i] : points[point].minimum[i];
      };
      Index at = corners[corner];
      for (const Index point : corners)
        if (!is_at_corners(limiter) &&
            (delta.v > 0 ? extremum_of(point) > extremum_of(at) : extremum_of(point) < extremum_of(at)))
          at = point;
      Dual<3> bound = extremum_of(at) - w[i], passed = epsilon2[i].v;
      delta.d[0] = bound.d[1] = passed.d[2] = 1;
      const Dual<3> factor = corner_factor<limiter>(delta, bound, passed);
      if (!(factor.v < out.factor[i])) continue;
      out.factor[i] = factor.v;
      out.by_delta[i] = factor.d[0];
      out.by_bound[i] = factor.d[1];
      out.by_density[i] = factor.d[2] * epsilon2[i].d[0];
      out.by_pressure[i] = factor.d[2] * epsilon2[i].d[1];
      out.corner[entry] = static_cast<std::uint8_t>(corner);
      bounded_at = at;
      extremum = extremum_of(at);
      change = std::max(std::abs(bound.v), std::abs(delta.v));
    }
    if (out.by_bound[i] == 0) continue;
    tied.clear();
    add_tied(domain, bounded_at, flow, i, extremum, change, tied);
    if (!is_at_corners(limiter))
      for (const Index point : corners)
        if (point != bounded_at) add_tied(domain, point, flow, i, extremum, change, tied);
    out.extremum[entry] = slopes.extremum_of(tied);
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
}

/// Makes the change of a gradient one of the limited gradient.
template <LimiterKind limiter, class T>
void follow_limiter(const LimiterSlopes& slopes, Index cell, const FlowField<T>& flow, const Offsets& offsets,
                    Gradient<T>& gradient) {
  const LimiterSlope& slope = slopes[cell];
  for (int i = 0; i < 5; ++i) {
    const auto entry = static_cast<std::size_t>(i);
    const T delta = change_at(gradient, reach(limiter) * offsets[slope.corner[entry]], i);
    const auto extrema = slopes.extrema(slope.extremum[entry]);
    T extremum = flow[extrema.front()][i];
    if (extrema.size() > 1) {
      for (const Index other : extrema.subspan(1)) extremum += flow[other][i];
      extremum = (1.0 / static_cast<Real>(extrema.size())) * extremum;
    }
    const T bound = extremum - flow[cell][i];
    const T factor = slope.by_delta[i] * delta + slope.by_bound[i] * bound +
                     slope.by_density[i] * flow[cell][0] + slope.by_pressure[i] * flow[cell][4];
    for (int axis = 0; axis < 3; ++axis)
      gradient.along[axis][i] =
          slope.factor[i] * gradient.along[axis][i] + slope.gradient.along[axis][i] * factor;
  }
}

}  // namespace alphadot
