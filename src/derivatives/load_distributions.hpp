// Where the steady loads of a case and their derivatives sit.
#pragma once

#include <map>
#include <vector>

#include "derivatives/distribution.hpp"
#include "derivatives/linear_derivatives.hpp"
#include "derivatives/part.hpp"
#include "derivatives/responses.hpp"

namespace alphadot {

class LoadDistributions {
 public:
  /// About the steady flow of the case; `solver` is the one that gave the responses, its limiter free.
  /// Collective.
  LoadDistributions(FlowCase& flow, SensitivitySolver& solver, const Responses& responses);

  /// Of the whole and of each set of walls that the case names, coefficients along x. Collective.
  std::vector<Distribution> along_body() const;
  /// Of the panel of each control, without the mirror image of a half model: loads in its frame along its
  /// outboard direction. None for those whose hinge is along x. Collective.
  std::vector<Distribution> along_panels() const;
  /// [boundary_faces] derivatives of the pressure coefficient on walls by flight variables and by single
  /// controls, zero on other boundaries: the force across each face per its area. By a control also what the
  /// area of the face changes by, which on the panel itself is nothing.
  FieldsOnFaces pressures() const;

 private:
  const FlowCase& flow_;
  std::vector<Load> steady_;                  // [boundary_faces]
  std::map<Variable, std::vector<Load>> by_;  // [boundary_faces], by reduced variables
};

}  // namespace alphadot
