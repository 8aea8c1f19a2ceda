// What mesh refinement says about the error that the mesh leaves.
#pragma once

#include <span>

#include "analysis/derivatives.hpp"
#include "analysis/estimate.hpp"

namespace alphadot {

/// One mesh level's result.
struct MeshLevel {
  GlobalIndex cells = 0;
  Real value = 0;
};

struct MeshConvergence {
  Estimate fine;           ///< finest value with its grid convergence index, absolute
  Real extrapolated = 0;   ///< Richardson's value at h = 0; the finest value when the levels do not converge
  Real order = 0;          ///< observed with three levels, otherwise the formal one
  Real safety_factor = 0;  ///< 1.25 with three levels in the asymptotic range, otherwise 3
  bool observed = false;   ///< the order was observed: three levels that converge monotonically
};

/// Ratio of the spacings of two meshes, h being proportional to cells^(-1/dimensions).
Real refinement_ratio(GlobalIndex fine_cells, GlobalIndex coarse_cells, int dimensions = 3);
/// The least that tells more than noise.
inline constexpr Real least_refinement_ratio = 1.05;

/// Richardson extrapolation and grid convergence index (Roache; Celik et al., J. Fluids Eng. 130, 2008,
/// 078001) of two or three levels in any order.
///
/// Three levels that converge monotonically give the observed order p; above the scheme's `formal_order` it
/// is cut to that, and below two fifths of it the levels are not in the asymptotic range, which the safety
/// factor answers. Otherwise, and where p were above two and a half times the formal order (two of the levels
/// then agree by accident), p is the formal order, the safety factor 3, and the largest difference of the
/// levels takes the place of that of the two finest.  GCI = F |f2 - f1| / (r^p - 1). Throws InputError for
/// another number of levels or a ratio of h below least_refinement_ratio.
MeshConvergence mesh_convergence(std::span<const MeshLevel> levels, int dimensions = 3,
                                 Real formal_order = 2);

/// All derivatives on one mesh.
struct MeshDerivatives {
  GlobalIndex cells = 0;
  DerivativeSet derivatives;
};

/// The same for every entry of two or three such sets, which have the same columns.
DerivativeSetOf<MeshConvergence> mesh_convergence(std::span<const MeshDerivatives> levels);

}  // namespace alphadot
