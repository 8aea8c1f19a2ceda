#include "derivatives/free_linearisation.hpp"

namespace alphadot {

Linearisation linearise_with_free_limiter(ImplicitIteration& iteration, const Conditions<Real>& conditions) {
  const Discretization& discretization = iteration.discretization();
  Reconstruction<Real> reconstruction(discretization, iteration.communicator());
  iteration.flow().start_exchange();
  if (discretization.space().order > 1) {
    reconstruction.update(iteration.flow());
    reconstruction.start_exchange();
    reconstruction.finish_exchange();
  } else {
    iteration.flow().finish_exchange();
  }
  return {discretization, iteration.communicator(), iteration.flow(), reconstruction, conditions};
}

}  // namespace alphadot
