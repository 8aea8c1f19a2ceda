// Where along the axis the moments balance.
#pragma once

#include "analysis/estimate.hpp"

namespace alphadot {

/// Static margin (x_neutral - x_center) / l = -Cm_alpha / CN_alpha about the centre: positive is stable.
Estimate static_margin(const Estimate& CN_alpha, const Estimate& Cm_alpha);

}  // namespace alphadot
