// What mesh refinement says about the error that the mesh leaves.
#pragma once

#include <span>

#include "analysis/derivatives.hpp"

namespace alphadot {

/// One mesh level's result.
struct MeshLevel {
  Real spacing = 0;  ///< mean, in any unit: the cube root of volume by cells
  Real value = 0;
};

struct MeshConvergence {
  Real extrapolated = 0;  ///< Richardson's value at h = 0; the finest value when the levels do not converge
  Real order = 0;         ///< observed with three levels, otherwise the formal one
  bool observed = false;  ///< the order was observed: three levels that converge monotonically
};

/// The least ratio of the spacings of two meshes that tells more than noise.
inline constexpr Real least_refinement_ratio = 1.05;

/// Order of the scheme in the spacing.
inline constexpr Real formal_order = 2;

/// Richardson extrapolation of two or three levels in any order (Celik et al., J. Fluids Eng. 130, 2008,
/// 078001).
///
/// Three levels that converge monotonically give the observed order p, cut to the formal one. Otherwise, and
/// where p were above two and a half times the formal order (two of the levels then agree by accident), p is
/// the formal order, and nothing is extrapolated from three levels. Throws InputError for another number of
/// levels or a ratio of spacings below least_refinement_ratio.
MeshConvergence mesh_convergence(std::span<const MeshLevel> levels);

/// All derivatives on one mesh.
struct MeshDerivatives {
  Real spacing = 0;  ///< as in MeshLevel
  DerivativeSet derivatives;
};

/// The same for every entry of two or three such sets, which have the same columns.
DerivativeSetOf<MeshConvergence> mesh_convergence(std::span<const MeshDerivatives> levels);

/// Half widths of intervals that hold the error of the finest of two or three meshes in 95 % of all entries;
/// scripts/calibration.py counts.
///
/// Differences of two meshes alone tell errors badly: some are small by accident. But the entries of one run
/// are about equally wrong by their scales s, root mean squares of the entry about centres a fifth of
/// `body_length` (in reference lengths) before and behind. Hence U = 2.75 hypot(e, s E): e is the error that
/// the differences of neighbours mean for the finest mesh if errors fall with the square of the spacing, root
/// mean square; E is e by s, the median of forces and moments by angles, rotations and rates of angles. A
/// third mesh widens no interval that two give.
DerivativeSetOf<Real> mesh_uncertainty(std::span<const MeshDerivatives> levels, Real body_length);

}  // namespace alphadot
