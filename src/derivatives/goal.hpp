// The derivatives that a mesh is adapted to.
#pragma once

#include <string>
#include <string_view>

#include "derivatives/adjoint_derivatives.hpp"
#include "derivatives/indicator.hpp"
#include "derivatives/linear_derivatives.hpp"

namespace alphadot {

/// A derivative of a load, "Cm_alphadot" or "CN_q@fin_1+fin_2".
struct Goal {
  Functional functional;  ///< whose adjoint gives it
  Variable variable;
  std::string name() const { return derivative_name(functional, alphadot::name(variable)); }
};

/// From its name, in which sets of walls may stand for their walls. Throws InputError that names `where` when
/// there is no such derivative or component, or when symmetry makes it zero.
Goal parse_goal(std::string_view name, const std::string& where, const FlightCondition& flight,
                const Components& components);

/// Its equations, with the solutions that adjoints and responses must have. Refers to these.
DerivativeChain chain_of(const Goal& goal, const FlowCase& flow, const Adjoints& adjoints,
                         const Responses& responses);

}  // namespace alphadot
