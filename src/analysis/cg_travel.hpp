// Stability and damping about several centres side by side: what the travel of the centre of gravity does.
#pragma once

#include <span>
#include <string>

#include "analysis/derivatives.hpp"
#include "core/vec3.hpp"

namespace alphadot {

/// Derivatives about one centre, which stands in the mesh's unit.
struct AboutCenter {
  Vec3 center;
  DerivativeSet derivatives;
};

/// A line a centre: x_cg (with y_cg and z_cg where they differ), Cm_alpha, Cm_q, Cm_alphadot, their sum Cm_q
/// + Cm_alphadot, which a forced pitch gives alone, and the static margin in lengths, each with its
/// uncertainty; a dash for what is not known. In the order given.
std::string cg_travel_table(std::span<const AboutCenter> centers);

}  // namespace alphadot
