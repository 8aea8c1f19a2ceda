// What a sinusoidal gust that the stream carries does to the linearised residual.
#pragma once

#include <array>
#include <vector>

#include "linear/linearisation.hpp"
#include "space/forces.hpp"

namespace alphadot {

/// A change of the residual that oscillates, real part and then imaginary one.
struct OscillatingSource {
  std::vector<Conserved<Real>> residual;   ///< [2 owned_cells]
  std::array<std::vector<Load>, 2> loads;  ///< of every patch, of this rank: what the walls bear at once
};

/// Of air that moves with `velocity` exp(i omega (t - (x - origin.x) / u)) across a stream with the velocity
/// u along x, by field velocity with the sources of the split velocity (space/conditions.hpp), as GustField
/// has it in time: the mean over each face. Moments about `origin`.
OscillatingSource gust_wave(const Linearisation& linearisation, const Vec3& velocity, Real omega,
                            const Vec3& origin);

}  // namespace alphadot
