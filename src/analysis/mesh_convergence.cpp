#include "analysis/mesh_convergence.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <vector>

#include "analysis/moment_transfer.hpp"
#include "core/error.hpp"

namespace alphadot {

namespace {

/// Times the scheme's order: levels that seem to converge faster are two that agree by accident.
constexpr Real largest_order = 2.5;

/// Covers 95 % of the entries of the first set of cases of scripts/calibration.py.
constexpr Real coverage_factor = 2.75;
/// Of the centres about which an entry is scaled, in lengths of the body.
constexpr Real lever = 0.2;

/// Solves e32 / e21 = r21^p (r32^p - 1) / (r21^p - 1) for 0 < p < `most` by bisection: the right side grows
/// with p, from ln r32 / ln r21 at p = 0. No value when the levels do not converge monotonically, or faster.
std::optional<Real> observed_order(Real ratio_of_changes, Real r21, Real r32, Real most) {
  const auto misfit = [&](Real p) {
    const Real a = std::pow(r21, p);
    return a * (std::pow(r32, p) - 1) / (a - 1) - ratio_of_changes;
  };
  Real low = 1e-3, high = most;
  if (!(misfit(low) < 0 && misfit(high) > 0)) return std::nullopt;
  while (high - low > 1e-12) {
    const Real middle = (low + high) / 2;
    (misfit(middle) < 0 ? low : high) = middle;
  }
  return low;
}

/// Refuses levels that tell nothing.
template <class Level>
std::vector<Level> finest_first(std::span<const Level> levels) {
  std::vector<Level> sorted(levels.begin(), levels.end());
  std::ranges::sort(sorted, std::less{}, &Level::spacing);
  if (sorted.size() < 2 || sorted.size() > 3 || !(sorted.front().spacing > 0))
    throw InputError("", 0, fmt::format("mesh convergence: {} levels given", sorted.size()),
                     "give two or three meshes with their spacings");
  for (std::size_t i = 1; i < sorted.size(); ++i)
    if (sorted[i].spacing / sorted[i - 1].spacing < least_refinement_ratio)
      throw InputError("", 0,
                       fmt::format("mesh convergence: spacings of {:g} and {:g} differ too little",
                                   sorted[i].spacing, sorted[i - 1].spacing),
                       "refine by at least 1.3 in each direction");
  return sorted;
}

/// Error of the finest mesh as each pair of neighbours tells it, root mean square.
Real error_by_differences(std::span<const MeshDerivatives> level, Variable variable, int coefficient) {
  Real sum = 0;
  for (std::size_t i = 0; i + 1 < level.size(); ++i) {
    const Real ratio = level[i + 1].spacing / level[i].spacing, finer = level[0].spacing / level[i].spacing;
    const Real change = level[i + 1].derivatives.at(variable)[coefficient].value -
                        level[i].derivatives.at(variable)[coefficient].value;
    const Real error = change * std::pow(finer, formal_order) / (std::pow(ratio, formal_order) - 1);
    sum += error * error;
  }
  return std::sqrt(sum / static_cast<Real>(level.size() - 1));
}

/// Root mean square of each entry about two centres.
DerivativeSetOf<Real> scales_of(const DerivativeSet& derivatives, Real body_length) {
  const Real arm = lever * body_length;
  const auto before = moment_transfer(derivatives, Vec3{-arm, 0, 0}),
             behind = moment_transfer(derivatives, Vec3{arm, 0, 0});
  DerivativeSetOf<Real> out;
  for (const auto& [variable, column] : derivatives)
    for (int i = 0; i < column.size(); ++i)
      out[variable][i] =
          std::hypot(before.at(variable)[i].value, behind.at(variable)[i].value) / std::sqrt(2.0);
  return out;
}

/// Errors by scales: median of forces and moments by angles, rotations and rates of angles, each of these as
/// a whole, since some entries are zero for symmetry.
Real relative_error(const DerivativeSetOf<Real>& errors, const DerivativeSetOf<Real>& scales) {
  using enum Variable;
  std::vector<Real> shares;
  for (const std::vector<Variable>& kind :
       {std::vector{alpha, beta}, std::vector{p, q, r}, std::vector{alphadot, betadot}})
    for (const int first : {0, 3}) {
      Real error = 0, scale = 0;
      for (const Variable variable : kind)
        for (int i = first; i < first + 3 && errors.contains(variable); ++i) {
          error = std::hypot(error, errors.at(variable)[i]);
          scale = std::hypot(scale, scales.at(variable)[i]);
        }
      if (scale > 0) shares.push_back(error / scale);
    }
  if (shares.empty()) return 0;
  std::ranges::sort(shares);
  return (shares[(shares.size() - 1) / 2] + shares[shares.size() / 2]) / 2;
}

/// Of all levels, the finest first.
DerivativeSetOf<Real> half_widths(std::span<const MeshDerivatives> level, Real body_length) {
  DerivativeSetOf<Real> out;
  for (const auto& [variable, column] : level.front().derivatives)
    for (int i = 0; i < column.size(); ++i) out[variable][i] = error_by_differences(level, variable, i);
  const auto scales = scales_of(level.front().derivatives, body_length);
  const Real relative = relative_error(out, scales);
  for (auto& [variable, column] : out)
    for (int i = 0; i < column.size(); ++i)
      column[i] = coverage_factor * std::hypot(column[i], relative * scales.at(variable)[i]);
  return out;
}

}  // namespace

MeshConvergence mesh_convergence(std::span<const MeshLevel> levels) {
  const auto level = finest_first(levels);
  const auto ratio = [&](std::size_t i) { return level[i + 1].spacing / level[i].spacing; };
  const Real r21 = ratio(0), e21 = level[1].value - level[0].value;
  MeshConvergence result{.extrapolated = level[0].value, .order = formal_order};
  bool converging = true;
  if (level.size() == 3) {
    const Real e32 = level[2].value - level[1].value;
    const auto order =
        e21 != 0 ? observed_order(e32 / e21, r21, ratio(1), largest_order * formal_order) : std::nullopt;
    result.observed = converging = order.has_value();
    if (order) result.order = std::min(*order, formal_order);
  }
  if (converging) result.extrapolated -= e21 / (std::pow(r21, result.order) - 1);
  return result;
}

DerivativeSetOf<MeshConvergence> mesh_convergence(std::span<const MeshDerivatives> levels) {
  DerivativeSetOf<MeshConvergence> out;
  for (const auto& [variable, column] : levels.front().derivatives)
    for (int i = 0; i < column.size(); ++i) {
      std::vector<MeshLevel> entry;
      for (const auto& level : levels)
        entry.push_back({level.spacing, level.derivatives.at(variable)[i].value});
      out[variable][i] = mesh_convergence(entry);
    }
  return out;
}

DerivativeSetOf<Real> mesh_uncertainty(std::span<const MeshDerivatives> levels, Real body_length) {
  const auto level = finest_first(levels);
  auto out = half_widths(std::span(level).first(2), body_length);
  if (level.size() == 3)
    for (const auto& [variable, column] : half_widths(level, body_length))
      for (int i = 0; i < column.size(); ++i) out[variable][i] = std::min(out[variable][i], column[i]);
  return out;
}

}  // namespace alphadot
