#include "analysis/mesh_convergence.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "core/error.hpp"

namespace alphadot {

namespace {

/// Times the scheme's order: levels that seem to converge faster are two that agree by accident.
constexpr Real largest_order = 2.5;

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

std::vector<MeshLevel> finest_first(std::span<const MeshLevel> levels) {
  std::vector<MeshLevel> sorted(levels.begin(), levels.end());
  std::ranges::sort(sorted, std::greater{}, &MeshLevel::cells);
  if (sorted.size() < 2 || sorted.size() > 3 || sorted.back().cells <= 0)
    throw InputError("", 0, fmt::format("mesh convergence: {} levels given", sorted.size()),
                     "give two or three meshes with their cell counts");
  return sorted;
}

}  // namespace

Real refinement_ratio(GlobalIndex fine_cells, GlobalIndex coarse_cells, int dimensions) {
  return std::pow(static_cast<Real>(fine_cells) / static_cast<Real>(coarse_cells), 1.0 / dimensions);
}

MeshConvergence mesh_convergence(std::span<const MeshLevel> levels, int dimensions, Real formal_order) {
  const auto level = finest_first(levels);
  const auto ratio = [&](std::size_t i) {
    const Real r = refinement_ratio(level[i].cells, level[i + 1].cells, dimensions);
    if (r < least_refinement_ratio)
      throw InputError("", 0,
                       fmt::format("mesh convergence: {} and {} cells differ too little", level[i + 1].cells,
                                   level[i].cells),
                       "refine by at least 1.3 in each direction");
    return r;
  };
  const Real r21 = ratio(0), e21 = level[1].value - level[0].value;
  MeshConvergence result{
      .fine = {level[0].value, 0}, .extrapolated = level[0].value, .order = formal_order, .safety_factor = 3};
  Real change = std::abs(e21);
  bool converging = true;
  if (level.size() == 3) {
    const Real r32 = ratio(1), e32 = level[2].value - level[1].value;
    const auto order =
        e21 != 0 ? observed_order(e32 / e21, r21, r32, largest_order * formal_order) : std::nullopt;
    result.observed = order.has_value();
    converging = result.observed || (e21 == 0 && e32 == 0);
    if (order) {
      result.order = std::min(*order, formal_order);
      if (*order >= 0.4 * formal_order) result.safety_factor = 1.25;
    } else {
      change = std::max({change, std::abs(e32), std::abs(e32 + e21)});
    }
  }
  const Real gain = 1 / (std::pow(r21, result.order) - 1);
  if (converging) result.extrapolated -= e21 * gain;
  result.fine.uncertainty = result.safety_factor * change * gain;
  return result;
}

DerivativeSetOf<MeshConvergence> mesh_convergence(std::span<const MeshDerivatives> levels) {
  DerivativeSetOf<MeshConvergence> out;
  for (const auto& [variable, column] : levels.front().derivatives)
    for (int i = 0; i < column.size(); ++i) {
      std::vector<MeshLevel> entry;
      for (const auto& level : levels)
        entry.push_back({level.cells, level.derivatives.at(variable)[i].value});
      out[variable][i] = mesh_convergence(entry);
    }
  return out;
}

}  // namespace alphadot
