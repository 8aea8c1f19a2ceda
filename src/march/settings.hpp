// How a flow comes to its steady state, and how it follows a motion.
#pragma once

#include "core/types.hpp"
#include "core/words.hpp"

namespace alphadot {

enum class SchemeKind { lu_sgs, block_lu_sgs };

namespace words {
inline constexpr Word<SchemeKind> scheme[] = {{"lu_sgs", SchemeKind::lu_sgs},
                                              {"block_lu_sgs", SchemeKind::block_lu_sgs}};
}
template <>
inline constexpr std::span<const Word<SchemeKind>> words_of<SchemeKind> = words::scheme;

struct SteadySettings {
  SchemeKind scheme = SchemeKind::block_lu_sgs;
  int sweeps = 0;              ///< pairs of passes of the block scheme; 0: as suits the free stream
  int krylov_directions = 20;  ///< most of a Newton-Krylov step, taken where the scheme is slow; 0: never
  Real cfl_start = 20;
  Real cfl_max = 1000;  ///< larger ones save little, and flow around fins at high incidence stands no more
  Real cfl_growth = 2;
  int max_iterations = 2000;
  Real orders = 10;  ///< decades that the density residual must drop
};

struct UnsteadySettings {
  Real cycles = 1.5;  ///< duration of a harmonic motion
  int steps_per_cycle = 48;
  Real duration = 0;  ///< t* = 2 V t / length; of a step, ramp or table
  int steps = 0;      ///< number of steps in `duration`
  Real inner_tolerance =
      1e-3;  ///< change of the out-of-phase moment between inner iterations, relative to it
  int max_inner = 100;
};

}  // namespace alphadot
