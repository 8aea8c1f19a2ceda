// Stability derivatives from the force history of a forced harmonic motion.
#pragma once

#include "analysis/derivatives.hpp"
#include "analysis/force_history.hpp"
#include "analysis/harmonic_fit.hpp"
#include "motion/settings.hpp"

namespace alphadot {

struct HarmonicDerivatives {
  EstimatedDerivatives estimated;
  CoefficientsOf<HarmonicFit> fits;  ///< basis in phase with the angle: sin is angle, cos is rate
  Real mean_angle = 0;               ///< rad
  Real amplitude = 0;                ///< rad
};

/// The derivatives that a harmonic motion at reduced frequency k shows:
///
/// | motion | angle | in phase | out of phase    |
/// |--------|-------|----------|-----------------|
/// | plunge | alpha | alpha    | alphadot        |
/// | pitch  | alpha | alpha    | q_plus_alphadot |
/// | flap   | theta |          | q               |
/// | sway   | beta  | beta     | betadot         |
/// | yaw    | beta  | beta     | r_minus_betadot |
/// | roll   | phi   |          | p               |
///
/// With angle = a0 + am sin(k t* + phase), X = X0 + X_angle am sin() + X_rate k am cos() (the paper's (6)),
/// so X_angle = in phase / am and X_rate = out of phase / (k am), per rad, rates with l/2V. a0, am and phase
/// are fitted to the angle's own history: no phase error enters from how the motion was set up. At finite k,
/// X_angle holds terms of order k^2, which linear solves are free of.
///
/// The plunge by field velocity, the paper's (4), keeps the axial velocity, so that the speed seen by the
/// body is V cos(a0) / cos(alpha) while the loads stay normalised with the fixed V. X_alpha is therefore the
/// slope at constant axial velocity (flight mechanics' X_w V), and of a flow with incidence the method says
/// so: it exceeds the slope at constant speed by tan(a0) dX/d(ln V), and nothing is renormalised here, for
/// the Mach number's share could not be taken out.
///
/// Parts of the uncertainty: "fit" and "inner" are those of FittedAmplitude; "amplitude" is what a finite
/// amplitude does, from the third harmonic: a term cubic in the angle puts three
/// times its third harmonic into the first, a kink, angle |angle|, five times; six is taken. One of angle^2
/// rate puts as much of it, one of |angle| rate five thirds; twice is taken. "time_step" is the damping that
/// the march in time leaves (see fitted_step): k damping_share of the rate derivative in X_angle, and in
/// X_rate damping_share of itself, an upper limit as long as 2 k X_rate' < X_rate, X_rate' being the next
/// term in frequency. That the limit k -> 0 is something else is in none of them.
///
/// basis.phase is ignored (see above). Throws InputError as fit_harmonics does, and when the motion has no
/// harmonic form or the angle's history is not a sine of this reduced frequency.
HarmonicDerivatives harmonic_derivatives(const ForceHistory& history, MotionKind motion, HarmonicBasis basis);

}  // namespace alphadot
