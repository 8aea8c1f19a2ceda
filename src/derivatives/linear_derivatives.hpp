// All stability derivatives of a case from linear solves about its steady flow.
#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "analysis/derivatives.hpp"
#include "analysis/panel.hpp"
#include "derivatives/distribution.hpp"
#include "derivatives/flow_case.hpp"
#include "derivatives/responses.hpp"

namespace alphadot {

/// Whoever goes along with linear solves.
struct SolveObserver {
  /// Asked after each linear iteration, on every rank; false ends the solves.
  std::function<bool()> go_on = {};
  /// A group of solutions is there: the moment for a checkpoint.
  std::function<void()> solved = {};
};

/// What some walls contribute to the derivatives of the whole.
struct ComponentDerivatives {
  std::string name;
  std::vector<std::string> walls;
  EstimatedDerivatives estimated;  ///< on a half model with the mirror image, whose lateral loads cancel
  EstimatedDerivatives one_side;   ///< of a half model: all loads of the walls of the mesh alone
};

/// What the panel of a control has, without the mirror image of a half model.
struct PanelDerivatives {
  std::string control;
  PanelFrame frame;
  EstimatedDerivatives estimated;  ///< of its walls, about the case's moment centre
};

/// Quantities by name, [boundary_faces].
using FieldsOnFaces = std::vector<std::pair<std::string, std::vector<Real>>>;

/// What linear solves give.
struct LinearDerivatives {
  /// About the case's moment centre, per rad and reduced rate. The parts are "linear", "steady", when the
  /// case asks for it "limiter", and in a flow that is its own mirror image "symmetry". No derivatives: the
  /// observer ended the solves.
  EstimatedDerivatives estimated;
  std::vector<ComponentDerivatives> components;  ///< each wall, and each set of walls of the case, by name
  std::vector<PanelDerivatives> panels;          ///< of every control
  /// Of the steady loads and all derivatives: along x of the whole and of the sets of walls; along each panel
  /// of a control, in its own frame. None when the case asks for no stations.
  std::vector<Distribution> along_body = {}, along_panels = {};
  /// cp_alpha, cp_q, ...; none when the case asks for no surface.
  FieldsOnFaces pressures = {};
  std::vector<std::string> shortfalls = {};  ///< solves that did not reach their tolerance
};

/// Solves for all derivatives about the steady flow that `flow` has marched to: alpha, q, alphadot, on a full
/// model also beta, p, r and betadot, on demand the second rates. `responses` has those that are there
/// already and takes the others. Collective. Throws DivergedError.
LinearDerivatives linear_derivatives(FlowCase& flow, Responses& responses,
                                     const SolveObserver& observer = {});

/// The responses alone, with the limiter free, and the solves that did not reach their tolerance. False when
/// the observer ended them. Collective. Throws DivergedError.
bool solve_responses(FlowCase& flow, Responses& responses, std::vector<std::string>& shortfalls,
                     const SolveObserver& observer = {});

/// Share of what is large in a response by which it may be off since the steady flow is so many decades down,
/// six or more: a bound.
Real steady_error(Real steady_orders);

/// Why a solve for `what` that dropped by this much in so many iterations falls short of the decades asked
/// for; empty when it does not.
std::string shortfall_of_solve(std::string_view what, Real relative_residual, int iterations, Real orders);

}  // namespace alphadot
