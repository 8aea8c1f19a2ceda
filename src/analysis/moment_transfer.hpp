// Derivatives about another moment centre.
#pragma once

#include "analysis/derivatives.hpp"
#include "core/vec3.hpp"

namespace alphadot {

/// All derivatives about a centre, which is also the centre of the rotations, moved by `offset` (mesh axes: x
/// aft, y starboard, z up; in reference lengths).
///
/// The rotation Omega about the new centre is the same rotation about the old one in a wind that has changed
/// by Omega x offset, for all of the body moves by -Omega x offset besides. In mesh axes Omega = (-p, q, -r),
/// and 2V over the length makes the reduced rates p*, q*, r* of it:
///   p: alpha' = -2 y p*, beta' = -2 z p*;   q: alpha' = -2 x q*, surge 2 z q*;   r: beta' = 2 x r*, surge 2
///   y r*
/// so that X_q' = X_q - 2 x X_alpha and so on for all six coefficients; the combined q + alphadot and
/// r - betadot likewise. Then every column is moved as loads are, which gives along the axis
///   Cm_q' = Cm_q + x CN_q - 2 x (Cm_alpha + x CN_alpha).
/// Derivatives by speed are not known: a column that needs them (q where z, r where y is not zero) is left
/// out. First order in alpha and beta: the surge that goes with x in a stream at incidence is neglected (it
/// belongs to CA, and to the others times the incidence), and so is 1 - cos(alpha). Throws InputError when
/// the derivatives by alpha or beta that a column needs are not in the set.
DerivativeSet moment_transfer(const DerivativeSet& about_old, const Vec3& offset);

/// The same with the parts of the uncertainty, each moved as the whole, and with what rests on derivatives
/// that are not converged.
EstimatedDerivatives moment_transfer(const EstimatedDerivatives& about_old, const Vec3& offset);

}  // namespace alphadot
