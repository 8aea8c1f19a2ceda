// Responses to conditions that oscillate. Expectations: the equation that they solve, with differences of
// residuals in place of the tangent; the responses for k -> 0, which another solver chains.
#include "derivatives/frequency_response.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>

#include "derivatives/sensitivity.hpp"
#include "support/linearised.hpp"
#include "support/ramp.hpp"
#include "support/steady_flow.hpp"

namespace alphadot {
namespace {

using namespace testing_support;

/// The ramp of test_sensitivity, steady to twelve decades; its Mach number oscillates.
class FrequencyTest : public testing::Test {
 protected:
  FrequencyTest()
      : box(ramp_mesh(8), ramp_sides(), {.freeze_orders = 0}, comm),
        conditions(steady_conditions({ramp_mach, 0, 0}, {}, gamma_air)),
        steady(box, conditions, 12) {}

  FrequencyResponse response(Real omega, std::span<const Primitive<Real>> guess = {}, Real orders = 10) {
    FrequencySolver solver(steady.iteration, conditions, {.orders = orders, .max_iterations = 600});
    FrequencyResponse out;
    EXPECT_TRUE(solver.solve({"mach", change, omega, guess}, out));
    EXPECT_LE(out.relative_residual, std::pow(10.0, -orders));
    return out;
  }

  const Communicator comm;
  const ConditionsChange change{{1, 0, 0}, {}, {}};
  const BoxCase box;
  const Conditions<Real> conditions;
  SteadyFlow steady;
};

// (A + i omega M) U = -R_c, whose A and R_c are central differences of residuals here.
TEST_F(FrequencyTest, SolvesTheEquation) {
  constexpr Real omega = 3, step = 1e-7;
  const auto cells = static_cast<std::size_t>(box.domain.owned_cells);
  const auto found = response(omega);
  const auto residual_at = [&](std::size_t part, Real share) {
    FlowField<Real> flow(box.domain, comm);
    for (Index cell = 0; cell < box.domain.owned_cells; ++cell)
      flow[cell] =
          steady.iteration.flow()[cell] + share * found.field[part * cells + static_cast<std::size_t>(cell)];
    const auto there = steady_conditions({ramp_mach + (part == 0 ? share : 0), 0, 0}, {}, gamma_air);
    std::vector<Conserved<Real>> out(box.cells());
    Residual(box.discretization, comm).evaluate(flow, there, 2, out);
    return out;
  };
  Real left = 0, whole = 0;
  for (std::size_t part = 0; part < 2; ++part) {
    const auto above = residual_at(part, step), below = residual_at(part, -step);
    for (std::size_t cell = 0; cell < cells; ++cell) {
      const auto mass = omega * box.domain.volume[cell] *
                        conserved_change(steady.iteration.flow()[static_cast<Index>(cell)],
                                         found.field[(1 - part) * cells + cell]);
      for (int i = 0; i < 5; ++i) {
        left += std::pow((above[cell][i] - below[cell][i]) / (2 * step) + (part == 0 ? -1 : 1) * mass[i], 2);
        whole += mass[i] * mass[i];
      }
    }
  }
  EXPECT_GT(comm.sum(whole), 0);
  EXPECT_LT(std::sqrt(comm.sum(left) / comm.sum(whole)), 1e-6);
}

// U = W_c + i omega W_cdot - omega^2 W_cdotdot - i omega^3 ...
TEST_F(FrequencyTest, BeginsWithTheResponsesToRates) {
  constexpr Real omega = 1e-2;
  const auto found = response(omega);
  SensitivitySolver solver(steady.iteration, conditions, {.orders = 11, .max_iterations = 600});
  const auto by_angle = solver.solve({{"mach", change}})[0];
  const auto by_rate = solver.solve({{"rate", {}, by_angle.field}})[0];
  const auto by_second = solver.solve({{"second rate", {}, by_rate.field}})[0];
  const Vec3 lag = (1 / omega) * found.total[1].force;
  const Vec3 curvature = (-1 / (omega * omega)) * (found.total[0].force - by_angle.total.force);
  EXPECT_GT(norm(by_rate.total.force), 1e-3);
  EXPECT_GT(norm(by_second.total.force), 1e-4);
  EXPECT_LT(norm(lag - by_rate.total.force), 1e-3 * norm(by_rate.total.force));
  EXPECT_LT(norm(curvature - by_second.total.force), 1e-2 * norm(by_second.total.force));
  EXPECT_LE(norm(found.total[0].force - by_angle.total.force),
            2 * omega * omega * norm(by_second.total.force));
}

TEST_F(FrequencyTest, IsTheSteadyResponseAtNoFrequency) {
  SensitivitySolver solver(steady.iteration, conditions, {.orders = 10, .max_iterations = 600});
  const auto steady_response = solver.solve({{"mach", change}})[0];
  const auto found = response(0);
  EXPECT_NEAR(norm(found.total[0].force - steady_response.total.force), 0, 1e-8);
  EXPECT_NEAR(norm(found.total[1].force), 0, 1e-12);
}

// A neighbour's solution saves iterations and changes nothing; what a cut solve may be off is held by its
// error.
TEST_F(FrequencyTest, ItsErrorHoldsAndAGuessSavesIterations) {
  const auto exact = response(1.0), neighbour = response(0.9), loose = response(1.0, {}, 2);
  const auto from_neighbour = response(1.0, neighbour.field, 2);
  EXPECT_LT(from_neighbour.iterations, loose.iterations);
  for (const auto* found : {&loose, &from_neighbour})
    for (std::size_t part = 0; part < 2; ++part)
      for (int axis = 0; axis < 3; ++axis)
        EXPECT_LE(std::abs(found->total[part].force[axis] - exact.total[part].force[axis]),
                  found->total_error[part].force[axis]);
}

}  // namespace
}  // namespace alphadot
