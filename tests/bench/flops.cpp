#include "bench/flops.hpp"

#include <vector>

// The residual's templates, to be compiled once more for the scalar that counts.
#include "space/reconstruction.cpp"  // NOLINT
#include "space/residual.cpp"        // NOLINT

namespace alphadot {

Operations residual_operations(const Discretization& discretization, const Communicator& comm,
                               const FlowField<Real>& flow, const Conditions<Real>& conditions) {
  const Subdomain& domain = discretization.domain();
  FlowField<Counted> counted(domain, comm);
  for (Index cell = 0; cell < domain.owned_cells; ++cell)
    for (int i = 0; i < 5; ++i) counted[cell][i] = flow[cell][i];
  Conditions<Counted> same;
  for (int i = 0; i < 5; ++i) same.free_stream[i] = conditions.free_stream[i];
  same.turning_source = false;
  std::vector<Conserved<Counted>> values(static_cast<std::size_t>(domain.owned_cells));
  Residual<Counted> residual(discretization, comm);
  Counted::operations = {};
  residual.evaluate(counted, same, 2, values);
  return Counted::operations;
}

}  // namespace alphadot
