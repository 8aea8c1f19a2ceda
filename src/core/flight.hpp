// What coefficients are referred to, and the stream that the body flies in.
#pragma once

#include "core/types.hpp"
#include "core/vec3.hpp"

namespace alphadot {

struct ReferenceSettings {
  Real length = 1;          ///< d (or c): makes moments and rates dimensionless
  Real area = 1;            ///< S of the whole configuration, also for a half model
  Vec3 moment_center;       ///< point about which moments are taken
  bool half_model = false;  ///< the mesh is the half y >= 0: forces are doubled, CY, Cl and Cn are zero
};

struct FreestreamSettings {
  Real mach = 0;
  Real alpha = 0;  ///< degrees
  Real beta = 0;   ///< degrees
  Real gamma = 1.4;
};

}  // namespace alphadot
