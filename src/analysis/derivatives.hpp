// Derivatives of the six coefficients with respect to the flight variables.
#pragma once

#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "analysis/coefficients.hpp"
#include "analysis/estimate.hpp"

namespace alphadot {

/// What a coefficient is differentiated by: angles in rad, rates times l/2V, second rates (alphaddot) times
/// (l/2V)^2. The last two are what forced pitch and forced yaw about a fixed axis yield: X_q + X_alphadot and
/// X_r - X_betadot (r = -betadot there).
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
  r_minus_betadot
};

/// "alpha", "q_plus_alphadot", ...
std::string_view name(Variable variable);

/// The name of one entry: "Cm" by alphadot is "Cm_alphadot".
std::string derivative_name(std::string_view coefficient, Variable variable);

/// The columns that are known, one for each variable.
template <class T>
using DerivativeSetOf = std::map<Variable, CoefficientsOf<T>>;
using DerivativeSet = DerivativeSetOf<Estimate>;

/// One source of uncertainty, "linear", "mesh", "time_step", ..., and its share in that of every entry.
struct UncertaintyPart {
  std::string source;
  DerivativeSetOf<Real> share;
};

/// Derivatives, and the parts that their uncertainties are the sums of.
struct EstimatedDerivatives {
  DerivativeSet derivatives;
  std::vector<UncertaintyPart> parts;
  /// Columns that rest on something that did not reach what was asked for.
  std::set<Variable> unconverged = {};

  const CoefficientsOf<Estimate>& at(Variable variable) const { return derivatives.at(variable); }
  /// Adds a part to the uncertainties.
  void add(std::string source, DerivativeSetOf<Real> share);
};

/// All derivatives about a centre, which is also the axis of rotation, moved aft by `dx` reference lengths.
///
/// Rotation about the new axis is rotation about the old one and a translation of the body by -Omega x dx:
/// upwards with q dx, to starboard with r dx, hence alpha' = -2 dx q*, beta' = +2 dx r*:
///   X_q' = X_q - 2 dx X_alpha,  X_r' = X_r + 2 dx X_beta  for all six coefficients, X_p unchanged;
/// the combined q + alphadot and r - betadot likewise. Then every column is moved as loads are, which gives
///   Cm_q' = Cm_q + dx CN_q - 2 dx (Cm_alpha + dx CN_alpha).
/// First order in alpha: the translation is normal to the body axis, so that 1 - cos(alpha) is neglected.
/// Throws InputError when a pitch (yaw) rate is in the set without alpha (beta).
DerivativeSet moment_transfer(const DerivativeSet& about_old, Real dx);

/// Reduced frequency at which the second-order term of X = (X_alpha + i k X_alphadot - k^2 X_alphaddot) alpha
/// reaches `share` of the first: there the derivatives for k -> 0 end to describe a plunge.
Real quasi_steady_limit(Real by_angle, Real by_second_rate, Real share);

/// Adds X_q = (X_q + X_alphadot) - X_alphadot, the paper's way to the damping derivative. All about one
/// centre. Throws InputError when either column is missing.
void add_damping_by_subtraction(DerivativeSet& derivatives);

}  // namespace alphadot
