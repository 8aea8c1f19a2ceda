// Derivatives of the six coefficients with respect to the flight variables.
#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "analysis/coefficients.hpp"
#include "analysis/estimate.hpp"

namespace alphadot {

/// What a coefficient is differentiated by: angles in rad, rates times l/2V, second rates (alphaddot) times
/// (l/2V)^2. q_plus_alphadot and r_minus_betadot are what forced pitch and forced yaw about a fixed axis
/// yield: X_q + X_alphadot and X_r - X_betadot (r = -betadot there). The gusts are waves of air that the
/// stream carries, upwards or along y, over V, with their phase at the moment centre: only at a frequency.
/// Beyond these: see control_variable().
enum class Variable {
  alpha,
  beta,
  p,
  q,
  r,
  alphadot,
  betadot,
  alphaddot,
  betaddot,
  q_plus_alphadot,
  r_minus_betadot,
  gust,
  side_gust
};

/// The deflection, in rad, of the control of this name: the same variable for the same name in all of the
/// program. Controls come behind all other variables, in the order in which they were first named.
Variable control_variable(std::string_view name);
bool is_control(Variable variable);  ///< a deflection, or the rate of one
/// The rate of a control's deflection, times l/2V: "tail_1dot". A control too.
Variable rate_of_control(Variable control);
bool is_control_rate(Variable variable);  ///< the rate of a deflection
/// What such a rate is the rate of.
Variable control_of_rate(Variable rate);

/// "alpha", "q_plus_alphadot", ..., or the name of the control.
std::string_view name(Variable variable);

/// The name of one entry: "Cm" by alphadot is "Cm_alphadot".
std::string derivative_name(std::string_view coefficient, Variable variable);

/// Coefficient (in the order of Coefficients) and variable of such a name; nothing for other names, unless
/// `may_be_control` and it is that of a derivative by a control.
std::optional<std::pair<int, Variable>> derivative_of_name(std::string_view name,
                                                           bool may_be_control = false);

/// Whether a control can have this name: letters, digits and underscores, a letter first; none of a flight
/// variable, of what else there are derivatives by ("mach", "gamma"), or of a rate.
bool is_control_name(std::string_view name);

/// The columns that are known, one for each variable.
template <class T>
using DerivativeSetOf = std::map<Variable, CoefficientsOf<T>>;
using DerivativeSet = DerivativeSetOf<Estimate>;

/// One source of uncertainty, "linear", "mesh", "time_step", ..., and what it adds to the half width of every
/// entry.
struct UncertaintyPart {
  std::string source;
  DerivativeSetOf<Real> half_width;
};

/// Derivatives, and the parts that their uncertainties are the sums of.
struct EstimatedDerivatives {
  DerivativeSet derivatives;
  std::vector<UncertaintyPart> parts;
  /// Columns that rest on something that did not reach what was asked for.
  std::set<Variable> unconverged = {};

  const CoefficientsOf<Estimate>& at(Variable variable) const { return derivatives.at(variable); }
  /// Adds a part to the uncertainties.
  void add(std::string source, DerivativeSetOf<Real> half_width);
};

/// Reduced frequency at which the second-order term of X = (X_alpha + i k X_alphadot - k^2 X_alphaddot) alpha
/// reaches `share` of the first: there the derivatives for k -> 0 end to describe a plunge.
Real quasi_steady_limit(Real by_angle, Real by_second_rate, Real share);

}  // namespace alphadot
