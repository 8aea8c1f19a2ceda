// Linear responses of steady flows. Expectations: a uniform stream that changes as a whole; differences of
// steady states; for the response to a rate, the slow drift of a nonlinear unsteady flow.
#include "solver/sensitivity.hpp"

#include <gtest/gtest.h>

#include "ramp.hpp"
#include "steady_flow.hpp"

namespace alphadot {
namespace {

using namespace testing_support;

constexpr Real decades = 10;

class SensitivityTest : public testing::TestWithParam<SensitivityMethod> {
 protected:
  SensitivityOptions options() const {
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
  SteadyFlow steady(box, conditions, 0);
  const auto responses = solve_sensitivities(
      steady.iteration, conditions,
      {{"alpha", {{0.2, -0.1, 1}, {}, {}}}, {"both", {{0.3, 0, 0}, {0, 0, 1}, {0.1, 0.2, -0.3}}}}, options());
  printf("steady %d %d resp %d %g %d %g\n",(int)steady.result.status,steady.result.iterations,responses[0].iterations,responses[0].relative_residual,responses[1].iterations,responses[1].relative_residual);
  const Vec3 winds[2] = {{0.2, -0.1, 1}, {0.3, 0, 0}};
  for (int k = 0; k < 2; ++k)
    for (const auto& w : responses[k].field) {
      EXPECT_NEAR(norm(velocity(w) - winds[k]), 0, 1e-8);
      EXPECT_NEAR(w[0], 0, 1e-8);
      EXPECT_NEAR(w[4], 0, 1e-8);
    }
}

// Steady states at Mach numbers (along x) a little above and below: central differences err by the square of
// the step and by what convergence of eleven decades leaves, divided by the step.
TEST_P(SensitivityTest, IsTheDerivativeOfSteadyStates) {
  constexpr Real step = 1e-5;
  const BoxCase box(ramp_mesh(8), ramp_sides(), {}, comm);
  const auto steady_at = [&](Real mach) {
    return SteadyFlow(box, steady_conditions({mach, 0, 0}, {}, gamma_air), 11);
  };
  auto middle = steady_at(ramp_mach);
  const auto response =
      solve_sensitivities(middle.iteration, steady_conditions({ramp_mach, 0, 0}, {}, gamma_air),
                          {{"mach", {{1, 0, 0}, {}, {}}}}, options())[0];
  EXPECT_LT(response.relative_residual, 1e-8);
  const auto above = steady_at(ramp_mach + step), below = steady_at(ramp_mach - step);
  for (Index cell = 0; cell < box.domain.owned_cells; ++cell)
    for (int i = 0; i < 5; ++i)
      EXPECT_NEAR(response.field[cell][i],
                  (above.iteration.flow()[cell][i] - below.iteration.flow()[cell][i]) / (2 * step), 1e-4);
  const Load difference = (0.5 / step) * (above.result.report.total - below.result.report.total);
  EXPECT_NEAR(norm(response.total.force - difference.force), 0, 1e-5);
  EXPECT_NEAR(norm(response.total.moment - difference.moment), 0, 1e-5);
}

}  // namespace
}  // namespace alphadot
