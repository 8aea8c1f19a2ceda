#include "derivatives/steady_error.hpp"

#include <algorithm>

#include "march/update.hpp"

namespace alphadot {

NewtonStep::NewtonStep(ImplicitIteration& iteration, const Conditions<Real>& conditions,
                       SensitivitySolver& solver)
    : iteration_(iteration) {
  const Discretization& discretization = iteration.discretization();
  auto& flow = iteration.flow();
  std::vector<Conserved<Real>> left(static_cast<std::size_t>(discretization.domain().owned_cells));
  Residual(discretization, iteration.communicator())
      .evaluate(flow, conditions, discretization.space().order, left);
  const auto solved = solver.solve({{.name = "the steady flow", .change = {}, .defect = left}});
  before_.assign(flow.values().begin(), flow.values().end());
  was_stopped_ = solved.empty();
  if (was_stopped_) return;
  const auto& step = solved.front().field;
  for (std::size_t cell = 0; cell < step.size(); ++cell) {
    auto& w = flow[static_cast<Index>(cell)];
    w += capped_share(w, step[cell]) * step[cell];
  }
}

NewtonStep::~NewtonStep() {
  std::ranges::copy(before_, iteration_.flow().values().begin());
}

}  // namespace alphadot
