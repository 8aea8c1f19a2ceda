// Which derivatives the symmetry of a steady flow makes zero.
#pragma once

#include "analysis/derivatives.hpp"
#include "derivatives/flow_case.hpp"
#include "derivatives/part.hpp"
#include "space/configuration.hpp"

namespace alphadot {

/// The planes about which a steady flow is its own mirror image, as far as the loads of the configuration or
/// of a part tell: that of x and y, and on a full model that of x and z. What these make zero is nothing but
/// error where it is computed: where limiter or flux has a kink in the flow itself, round-off chooses a side.
class FlowSymmetry {
 public:
  /// `loads`: in the steady flow. Those that a mirror turns round count as zero below 1e-6 of what a pressure
  /// on all walls like the dynamic one would make.
  FlowSymmetry(const Coefficients& loads, const Configuration& configuration, bool half_model);

  /// Whether there is a plane.
  bool is_any() const { return is_level_ || is_upright_; }
  /// Whether the derivative of a coefficient, by its number, by a flight variable is zero: one of them
  /// changes sign in a mirror, and the other does not. Of no control.
  bool makes_zero(int coefficient, Variable variable) const;

 private:
  bool is_level_;    // about the plane of x and y
  bool is_upright_;  // about that of x and z
};

/// About a part of the configuration, of whose coefficients `settings` are.
FlowSymmetry symmetry_of(const Part& part, const FlowCase& flow, const FlightCondition& settings);

}  // namespace alphadot
