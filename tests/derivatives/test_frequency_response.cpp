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

  /// To each of the oscillations, at each of the frequencies.
  std::vector<std::vector<FrequencyResponse>> responses(const std::vector<Oscillation>& oscillations,
                                                        const std::vector<Frequency>& frequencies,
                                                        Real orders) {
    FrequencySolver solver(steady.iteration, conditions, {.orders = orders, .max_iterations = 600},
                           oscillations);
    std::vector<std::vector<FrequencyResponse>> out(frequencies.size());
    EXPECT_TRUE(solver.solve(frequencies, [&](std::size_t number, std::vector<FrequencyResponse> found) {
      for (const auto& response : found) EXPECT_LE(response.relative_residual, std::pow(10.0, -orders));
      out[number] = std::move(found);
    }));
    return out;
  }
  FrequencyResponse response(Real omega, Real orders = 10) {
    return responses({{"mach", change}}, {{omega}}, orders)[0][0];
  }
  static void expect_within_error(const FrequencyResponse& found, const FrequencyResponse& exact) {
    for (std::size_t part = 0; part < 2; ++part)
      for (int axis = 0; axis < 3; ++axis)
        EXPECT_LE(std::abs(found.total[part].force[axis] - exact.total[part].force[axis]),
                  found.total_error[part].force[axis]);
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

// What others tell saves iterations and changes nothing; what a cut solve may be off is held by its error,
// also where no iteration was needed.
TEST_F(FrequencyTest, ItsErrorHoldsAndOthersSaveIterations) {
  const std::vector<Frequency> frequencies{{0.3}, {0.5}, {0.7}, {0.9}, {1.0}, {1.1}, {1.3}, {1.5}};
  const auto together = responses({{"mach", change}}, frequencies, 2);
  int sum = 0, fewest = 1000;
  for (std::size_t i = 0; i < frequencies.size(); ++i) {
    expect_within_error(together[i][0], response(frequencies[i].omega));
    sum += together[i][0].iterations;
    fewest = std::min(fewest, together[i][0].iterations);
  }
  const auto alone = response(1.0, 2);
  expect_within_error(alone, response(1.0));
  EXPECT_LT(sum, static_cast<int>(frequencies.size()) / 2 * alone.iterations);
  EXPECT_EQ(fewest, 0);
}

// Two of them share the work, not the answer.
TEST_F(FrequencyTest, OscillationsThatAreSolvedForTogetherStayApart) {
  const Oscillation mach{"mach", change}, alpha{"alpha", {{0, 0, 1}, {}, {}}};
  const auto together = responses({mach, alpha}, {{1.0}, {2.0}}, 10);
  for (std::size_t i = 0; i < 2; ++i)
    for (std::size_t k = 0; k < 2; ++k) {
      const auto alone = responses({k == 0 ? mach : alpha}, {{i == 0 ? 1.0 : 2.0}}, 10)[0][0];
      for (std::size_t part = 0; part < 2; ++part)
        EXPECT_LE(norm(together[i][k].total[part].force - alone.total[part].force), 1e-8);
    }
}

// At a low frequency the imaginary part is small, and as sure by its weight as the real one.
TEST_F(FrequencyTest, TheWeightOfTheImaginaryPartMakesItSure) {
  constexpr Real omega = 1e-3;
  const auto exact = response(omega, 11);
  const auto plain = responses({{"mach", change}}, {{omega}}, 3)[0][0],
             weighted = responses({{"mach", change}}, {{omega, 1 / omega}}, 3)[0][0];
  expect_within_error(plain, exact);
  expect_within_error(weighted, exact);
  EXPECT_LT(norm(weighted.total_error[1].force), 0.1 * norm(weighted.total_error[0].force));
  EXPECT_LT(norm(weighted.total_error[1].force), 0.05 * norm(exact.total[1].force));
}

}  // namespace
}  // namespace alphadot
