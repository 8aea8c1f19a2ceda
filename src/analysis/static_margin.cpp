#include "analysis/static_margin.hpp"

#include <cmath>

namespace alphadot {

Estimate static_margin(const Estimate& CN_alpha, const Estimate& Cm_alpha) {
  const Real margin = -Cm_alpha.value / CN_alpha.value;
  return {margin,
          (Cm_alpha.uncertainty + std::abs(margin) * CN_alpha.uncertainty) / std::abs(CN_alpha.value)};
}

}  // namespace alphadot
