// The paper's Table I, and computed values beside it.
#pragma once

#include <array>
#include <span>
#include <string>

#include "analysis/derivatives.hpp"

namespace alphadot {

/// A line of Table I of "An Effective Computation Method Based on Field Velocity Approach for Acceleration
/// Derivative": Basic Finner, alpha0 = 1.5 deg, amplitude 1 deg, k = omega d / 2V = 0.01, per rad, rates with
/// d / 2V. The moment centre is not stated. grid: moving grid; field: field velocity.
struct PaperRow {
  Real mach;
  Real static_grid, static_field, static_experiment;
  Real acceleration_grid, acceleration_field;
  Real damping_grid, damping_field;
};

inline constexpr std::array<PaperRow, 5> paper_table_one = {{
    {1.58, -41.0236, -41.0254, -42.2853, 2.6848, 2.6963, -462.7634, -475.0016},
    {1.75, -33.9610, -33.9620, -35.0014, -14.0742, -14.2431, -427.3870, -437.1490},
    {1.89, -29.7153, -29.7162, -31.6217, -22.1835, -22.1916, -403.8817, -411.8878},
    {2.10, -24.9780, -24.9784, -24.7692, -28.9742, -28.9805, -374.9710, -380.8316},
    {2.50, -19.1331, -19.1333, -20.7738, -32.3266, -32.4077, -330.5489, -334.9547},
}};

/// Computed derivatives at one Mach number about a common centre; columns that are missing leave gaps.
struct ComputedPoint {
  Real mach = 0;
  DerivativeSet derivatives;
};

/// Markdown tables of Cm_alpha, Cm_alphadot and Cm_q at the paper's Mach numbers: computed about `x_center`
/// (the derivatives' own centre, reference lengths from the nose) and about `x_fitted`, the paper's
/// field-velocity value and the difference from it (in per cent; of the acceleration derivative, which
/// changes sign, absolute). Mach numbers that the paper has not are left out. Throws InputError as
/// moment_transfer does.
std::string paper_comparison(std::span<const ComputedPoint> points, Real x_center, Real x_fitted);

}  // namespace alphadot
