// How the residual is discretized.
#pragma once

#include "core/types.hpp"
#include "core/words.hpp"
#include "euler/kinds.hpp"

namespace alphadot {

enum class GradientKind { least_squares, green_gauss };

namespace words {
inline constexpr Word<GradientKind> gradient[] = {{"least_squares", GradientKind::least_squares},
                                                  {"green_gauss", GradientKind::green_gauss}};
}
template <>
inline constexpr std::span<const Word<GradientKind>> words_of<GradientKind> = words::gradient;

enum class LimiterKind { venkatakrishnan, mlp_u2, barth_jespersen, none };

namespace words {
inline constexpr Word<LimiterKind> limiter[] = {{"venkatakrishnan", LimiterKind::venkatakrishnan},
                                                {"mlp_u2", LimiterKind::mlp_u2},
                                                {"barth_jespersen", LimiterKind::barth_jespersen},
                                                {"none", LimiterKind::none}};
}
template <>
inline constexpr std::span<const Word<LimiterKind>> words_of<LimiterKind> = words::limiter;

/// How walls of controls turn: the mesh deforms with them; or it stays, and gas passes their faces as if they
/// had turned (turned_walls.hpp).
enum class DeflectionKind { mesh, transpiration };

namespace words {
inline constexpr Word<DeflectionKind> deflection[] = {{"mesh", DeflectionKind::mesh},
                                                      {"transpiration", DeflectionKind::transpiration}};
}
template <>
inline constexpr std::span<const Word<DeflectionKind>> words_of<DeflectionKind> = words::deflection;

struct SpaceSettings {
  FluxKind flux = FluxKind::roe;
  int order = 2;
  GradientKind gradient = GradientKind::least_squares;
  LimiterKind limiter = LimiterKind::venkatakrishnan;
  /// Share of a cell's own density, speed of sound and pressure up to which changes pass the limiter.
  Real limiter_threshold = 0.2;
  /// Decades of residual after which the limiter is frozen; before, where the march stalls; 0: never. The
  /// flow that it is frozen at depends on the way there, which one that came to rest does not.
  Real freeze_orders = 16;
  Real entropy_fix = 0.1;  ///< Harten's delta as a share of the spectral radius
  /// Whether the cells in the lee of walls that face aft are dissipative in a supersonic stream
  /// (lee_cells.hpp).
  bool dissipative_lee = true;
  DeflectionKind deflection = DeflectionKind::mesh;
};

}  // namespace alphadot
