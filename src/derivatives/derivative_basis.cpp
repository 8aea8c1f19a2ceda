#include "derivatives/derivative_basis.hpp"

#include <utility>

#include "space/influence.hpp"

namespace alphadot {

namespace {

Linearisation linearise_with_free_limiter(ImplicitIteration& iteration, const Conditions<Real>& conditions) {
  const Discretization& discretization = iteration.discretization();
  Reconstruction<Real> reconstruction(discretization, iteration.communicator());
  reconstruction.update(iteration.flow(), discretization.space().order);
  return {discretization, iteration.communicator(), iteration.flow(), reconstruction, conditions};
}

}  // namespace

DerivativeBasis::DerivativeBasis(ImplicitIteration& about, const Conditions<Real>& conditions,
                                 const DerivativeSettings& how, std::function<bool()> ask)
    : iteration(about),
      linearisation(linearise_with_free_limiter(about, conditions)),
      settings(how),
      go_on(std::move(ask)),
      body_size(Influence(about.discretization(), velocity(conditions.free_stream), about.communicator())
                    .body_size()) {}

}  // namespace alphadot
