// The functionals that adjoints are solved for: coefficients of the body or of some of its patches.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "analysis/derivatives.hpp"
#include "derivatives/adjoint.hpp"
#include "derivatives/part.hpp"
#include "motion/flight_condition.hpp"

namespace alphadot {

/// A coefficient, or its response to the rates (1) or second rates (2) of the angles.
struct Functional {
  int coefficient = 0;                    ///< number in coefficient_names
  std::vector<std::string> patches = {};  ///< whose loads count; empty: all walls
  int rates = 0;

  /// "Cm", "Cm_alphadot", "CN@fin_1+fin_2".
  std::string name() const;
  /// The one before in the chain of those to rates.
  Functional before() const { return {coefficient, patches, rates - 1}; }
};

/// Whether symmetry makes a coefficient, by its number, zero.
bool vanishes(int coefficient, const FlightCondition& settings);

/// From its name, in which sets of walls may stand for their walls. Throws InputError that names `where` when
/// there is no such coefficient or component, or when symmetry makes it zero.
Functional parse_functional(std::string_view name, const std::string& where, const FlightCondition& flight,
                            const Components& components);

/// What it takes of the load of every patch; nothing of those that are not its own.
std::vector<Load> weights_of(const Functional& functional, const std::vector<std::string>& patch_names,
                             const FlightCondition& settings);

/// What it can be differentiated by: alpha, q (and beta, p, r on a full model), or their rates.
std::vector<Variable> variables_of(const Functional& functional, const FlightCondition& settings);

/// The name of a derivative, "Cm_alpha" or "Cm_alpha@fin_1".
std::string derivative_name(const Functional& functional, std::string_view variable);

/// The derivative that an adjoint of the functional gives, by the reduced variable; the uncertainty is what
/// the linear solve leaves.
Estimate derivative(const Adjoint& adjoint, Variable variable, const FlightCondition& settings);

}  // namespace alphadot
