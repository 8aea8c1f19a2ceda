// Linear responses of steady flows. Expectations: a uniform stream that changes as a whole; differences of
// steady states; for the response to a rate, the equation it solves, with residuals in place of the tangent.
#include "derivatives/sensitivity.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "support/linearised.hpp"
#include "support/ramp.hpp"
#include "support/steady_flow.hpp"

namespace alphadot {
namespace {

using namespace testing_support;

constexpr Real decades = 10;

class SensitivityTest : public testing::TestWithParam<SensitivityMethod> {
 protected:
  DerivativeSettings options() const {
    return {.method = GetParam(), .orders = decades, .max_iterations = 600};
  }
  const Communicator comm;
};
INSTANTIATE_TEST_SUITE_P(Methods, SensitivityTest,
                         testing::Values(SensitivityMethod::gmres, SensitivityMethod::march),
                         [](const auto& method) {
                           return method.param == SensitivityMethod::gmres ? "gmres" : "march";
                         });

// In an open box the whole stream follows the far field, and a grid that moves or turns with it changes
// nothing.
TEST_P(SensitivityTest, IsTheChangeOfTheWholeStream) {
  const BoxCase box(small_box(), open_box(), {}, comm);
  const auto conditions = steady_conditions({1.5, 0.1, -0.2}, {0.4, -0.6, 0.2}, gamma_air);
  ImplicitIteration iteration(box.discretization, comm,
                              std::make_unique<BlockLuSgs>(box.discretization, comm, 3), {});
  iteration.set_uniform(conditions.free_stream);
  iteration.evaluate(conditions, 2);
  const auto responses = SensitivitySolver(iteration, conditions, options())
                             .solve({{"wind", {{0.2, -0.1, 1}, {}, {}}},
                                     {"wind and grid", {{0.3, 0, 0}, {0, 0, 1}, {0.1, 0.2, -0.3}}}});
  const Vec3 winds[2] = {{0.2, -0.1, 1}, {0.3, 0, 0}};
  for (int k = 0; k < 2; ++k)
    for (const auto& w : responses[k].field) {
      EXPECT_NEAR(norm(velocity(w) - winds[k]), 0, 1e-8);
      EXPECT_NEAR(w[0], 0, 1e-8);
      EXPECT_NEAR(w[4], 0, 1e-8);
    }
}

/// The ramp, steady to twelve decades, at a Mach number along x.
struct RampAt {
  RampAt(const BoxCase& box, Real mach)
      : conditions(steady_conditions({mach, 0, 0}, {}, gamma_air)), steady(box, conditions, 12) {}
  Conditions<Real> conditions;
  SteadyFlow steady;
};
const SensitivityProblem mach_problem{"mach", {{1, 0, 0}, {}, {}}};

// Steady states at Mach numbers a little above and below. A small step, since limiter and fluxes have kinks
// that a larger one would straddle in some cell: what twelve decades of convergence leave, 1e-12, is divided
// by it.
TEST_P(SensitivityTest, IsTheDerivativeOfSteadyStates) {
  constexpr Real step = 1e-6;
  const BoxCase box(ramp_mesh(8), ramp_sides(), {.freeze_orders = 0}, comm);
  RampAt middle(box, ramp_mach);
  const RampAt above(box, ramp_mach + step), below(box, ramp_mach - step);
  const auto response =
      SensitivitySolver(middle.steady.iteration, middle.conditions, options()).solve({mach_problem})[0];
  EXPECT_LT(response.relative_residual, 1e-8);
  // However deep the solve: within 0.002 degrees derivatives of steady flows of cones and finners change so.
  EXPECT_GT(norm(response.total_error.force), 6e-6 * norm(response.total.force));
  for (Index cell = 0; cell < box.domain.owned_cells; ++cell)
    for (int i = 0; i < 5; ++i) {
      const Real difference = above.steady.iteration.flow()[cell][i] - below.steady.iteration.flow()[cell][i];
      EXPECT_NEAR(response.field[cell][i], difference / (2 * step), 1e-6);
    }
  const Load difference =
      (0.5 / step) * (above.steady.result.report.total - below.steady.result.report.total);
  EXPECT_NEAR(norm(response.total.force - difference.force), 0, 1e-6);
  EXPECT_NEAR(norm(response.total.moment - difference.moment), 0, 1e-6);
}

/// The ramp between open sides, so that it may roll; the wind turns with it about a point above the wall. It
/// comes from below and from the side: a far field along the wind, neither inflow nor outflow, switches
/// between the two, and has no derivative.
struct OpenRamp {
  static constexpr Real alpha = 0.05, beta = 0.1;
  static constexpr Vec3 axis{0.3, 0.02, 0.1};
  static BoxSides sides() {
    auto out = ramp_sides();
    out[2] = out[3] = BoundaryKind::farfield;
    return out;
  }
  static Conditions<Real> conditions(Real more_alpha, const Vec3& rotation) {
    return steady_conditions(wind_velocity(ramp_mach, alpha + more_alpha, beta), axis, gamma_air, rotation);
  }
};

// The variables of flight, against steady flows a little to either side, as above: alpha by a body that
// sinks, but by a wind that is turned in the differences, which is the same to an observer who sinks with the
// body; q and p by steady rotation.
TEST_P(SensitivityTest, IsTheDerivativeOfSteadyStatesInFlight) {
  constexpr Real step = 1e-6;
  const BoxCase box(ramp_mesh(8), OpenRamp::sides(), {.freeze_orders = 0}, comm);
  const auto conditions = OpenRamp::conditions(0, {});
  SteadyFlow middle(box, conditions, 12);
  // d(wind)/d(alpha) at constant speed; the body moves the other way.
  const Vec3 turned = (0.5 / step) * (wind_velocity(ramp_mach, OpenRamp::alpha + step, OpenRamp::beta) -
                                      wind_velocity(ramp_mach, OpenRamp::alpha - step, OpenRamp::beta));
  const Vec3 pitching{0, 1, 0}, rolling{-1, 0, 0};
  const auto responses =
      SensitivitySolver(middle.iteration, conditions, options())
          .solve({{"alpha", {{}, -1 * turned, {}}}, {"q", {{}, {}, pitching}}, {"p", {{}, {}, rolling}}});
  const auto expect_difference = [&](const Sensitivity& response, Real alpha, const Vec3& rotation,
                                     const Vec3& observer) {
    SCOPED_TRACE(response.name);
    const SteadyFlow above(box, OpenRamp::conditions(alpha * step, step * rotation), 12);
    const SteadyFlow below(box, OpenRamp::conditions(-alpha * step, -step * rotation), 12);
    for (const auto* steady : {&above, &below}) ASSERT_EQ(steady->result.status, RunStatus::converged);
    EXPECT_LT(response.relative_residual, 1e-8);
    Real largest = 0;
    for (Index cell = 0; cell < box.domain.owned_cells; ++cell) {
      auto difference = (0.5 / step) * (above.iteration.flow()[cell] - below.iteration.flow()[cell]);
      for (int d = 0; d < 3; ++d) difference[d + 1] += observer[d];
      for (int i = 0; i < 5; ++i) {
        EXPECT_NEAR(response.field[cell][i], difference[i], 1e-6);
        largest = std::max(largest, std::abs(difference[i]));
      }
    }
    EXPECT_GT(comm.max(largest), response.name == "p" ? 0.05 : 0.1) << "a response that is there";
    const Load difference = (0.5 / step) * (above.result.report.total - below.result.report.total);
    EXPECT_NEAR(norm(response.total.force - difference.force), 0, 1e-6);
    EXPECT_NEAR(norm(response.total.moment - difference.moment), 0, 1e-6);
  };
  expect_difference(responses[0], 1, {}, -1 * turned);
  expect_difference(responses[1], 0, pitching, {});
  expect_difference(responses[2], 0, rolling, {});
}

// The response to a rate solves (dR/dW) W_cdot = -V (dU/dW) W_c, whose left side is a difference of residuals
// here.
TEST_P(SensitivityTest, AnswersARateWithTheMassOfTheFlow) {
  constexpr Real step = 1e-7;
  const BoxCase box(ramp_mesh(8), ramp_sides(), {.freeze_orders = 0}, comm);
  RampAt ramp(box, ramp_mach);
  ImplicitIteration& iteration = ramp.steady.iteration;
  SensitivitySolver solver(iteration, ramp.conditions, options());
  const auto steady = solver.solve({mach_problem})[0];
  const auto rate = solver.solve({{"rate", {}, steady.field}})[0];

  const auto residual_at = [&](Real share) {
    FlowField<Real> flow(box.domain, comm);
    for (Index cell = 0; cell < box.domain.owned_cells; ++cell)
      flow[cell] = iteration.flow()[cell] + share * rate.field[cell];
    std::vector<Conserved<Real>> out(box.cells());
    Residual(box.discretization, comm).evaluate(flow, ramp.conditions, 2, out);
    return out;
  };
  const auto above = residual_at(step), below = residual_at(-step);
  Real left = 0, whole = 0;
  for (Index cell = 0; cell < box.domain.owned_cells; ++cell) {
    const auto mass = box.domain.volume[cell] * conserved_change(iteration.flow()[cell], steady.field[cell]);
    for (int i = 0; i < 5; ++i) {
      left += std::pow((above[cell][i] - below[cell][i]) / (2 * step) + mass[i], 2);
      whole += mass[i] * mass[i];
    }
  }
  EXPECT_LT(std::sqrt(comm.sum(left) / comm.sum(whole)), 1e-6);
}

}  // namespace
}  // namespace alphadot
