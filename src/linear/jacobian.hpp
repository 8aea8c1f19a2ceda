// Assembly of the first-order Jacobian, exact for the flux in use.
#pragma once

#include "linear/block_matrix.hpp"
#include "linear/linear_solver.hpp"

namespace alphadot {

/// Fills `matrix` with dR1/dW of the first-order residual about `flow` plus the time terms, diagonal blocks
/// inverted. Fluxes are differentiated forward in the five entries of either state: about 3,000 flops a face.
void assemble_jacobian(const Discretization& discretization, const FlowField<Real>& flow,
                       const Conditions<Real>& conditions, const TimeTerms& time, BlockMatrix& matrix);

}  // namespace alphadot
