// From body axes to stability and wind axes.
#pragma once

#include <array>
#include <cmath>
#include <string_view>

#include "analysis/derivatives.hpp"

namespace alphadot {

/// The axes that a set of coefficients and derivatives refers to.
enum class Axes { body, stability };

inline constexpr std::array<std::string_view, 6> stability_names = {"CD", "CY", "CL", "Cl", "Cm", "Cn"};

/// Names of the six coefficients in these axes, in the order of CoefficientsOf::operator[].
constexpr const std::array<std::string_view, 6>& names_in(Axes axes) {
  return axes == Axes::body ? coefficient_names : stability_names;
}

/// The loads on stability axes, which are body axes turned by `alpha` (rad) about y so that x lies along the
/// projection of the flight path: the entry CA then holds CD, CN holds CL, Cl and Cn are about the turned
/// axes.
template <class T>
CoefficientsOf<T> to_stability_axes(const CoefficientsOf<T>& body, Real alpha) {
  const Real c = std::cos(alpha), s = std::sin(alpha);
  return {.CA = c * body.CA + s * body.CN,
          .CY = body.CY,
          .CN = c * body.CN + -s * body.CA,
          .Cl = c * body.Cl + s * body.Cn,
          .Cm = body.Cm,
          .Cn = c * body.Cn + -s * body.Cl};
}

/// Derivatives on stability axes. The axes turn with alpha, so that CL_alpha = CN_alpha cos - CA_alpha sin -
/// CD and so on, with `steady` the loads on body axes at `alpha` (rad); rates p and r are about the turned
/// axes too. r_minus_betadot keeps its yaw about the body's z axis. Throws InputError when alpha is not zero
/// and only one of p and r is known.
DerivativeSet to_stability_axes(const DerivativeSet& body, const Coefficients& steady, Real alpha);

}  // namespace alphadot
