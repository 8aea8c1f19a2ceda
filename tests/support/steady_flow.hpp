// A march to the steady state on a box case.
#pragma once

#include <memory>

#include "linear/block_lu_sgs.hpp"
#include "march/steady.hpp"
#include "support/box_case.hpp"

namespace alphadot::testing_support {

/// Starts from the free stream and goes on until the density residual has dropped by `orders` decades.
struct SteadyFlow {
  SteadyFlow(const BoxCase& box, const Conditions<Real>& conditions, Real orders,
             std::unique_ptr<LinearSolver> solver = nullptr,
             int krylov_directions = SteadySettings{}.krylov_directions)
      : iteration(box.discretization, box.comm,
                  solver ? std::move(solver) : std::make_unique<BlockLuSgs>(box.discretization, box.comm, 3),
                  {}) {
    iteration.set_uniform(conditions.free_stream);
    SteadySettings settings;
    settings.orders = orders;
    settings.max_iterations = 3000;
    settings.krylov_directions = krylov_directions;
    result = march_to_steady(iteration, conditions, settings, box.discretization.space().order,
                             [this](const SteadyProgress& progress) {
                               if (progress.state.krylov == KrylovSteps::taken) ++krylov_steps;
                               return true;
                             });
  }

  ImplicitIteration iteration;
  int krylov_steps = 0;
  SteadyResult result;
};

}  // namespace alphadot::testing_support
