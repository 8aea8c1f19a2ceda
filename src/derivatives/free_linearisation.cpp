#include "derivatives/free_linearisation.hpp"

namespace alphadot {

Linearisation linearise_with_free_limiter(ImplicitIteration& iteration, const Conditions<Real>& conditions) {
  const Discretization& discretization = iteration.discretization();
  Reconstruction<Real> reconstruction(discretization, iteration.communicator());
  reconstruction.update(iteration.flow(), discretization.space().order);
  return {discretization, iteration.communicator(), iteration.flow(), reconstruction, conditions};
}

}  // namespace alphadot
