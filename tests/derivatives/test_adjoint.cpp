// Adjoints of loads about steady flows. The expected numbers are the forward solves', whose equations tests
// of their own prove: a derivative is one number, whichever way it is found.
#include "derivatives/adjoint.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string_view>

#include "derivatives/sensitivity.hpp"
#include "support/ramp.hpp"
#include "support/steady_flow.hpp"

namespace alphadot {
namespace {

using namespace testing_support;

constexpr Real decades = 10, as_one = 1e-8;

Real product(const ConditionsChange& a, const ConditionsChange& b) {
  return dot(a.wind, b.wind) + dot(a.grid_velocity, b.grid_velocity) + dot(a.rotation, b.rotation);
}

struct Problem {
  const char* name;
  ConditionsChange change;
};
/// Plunge, pitch rate and Mach number.
const Problem problems[] = {
    {"alpha", {{}, {0, 0, -ramp_mach}, {}}}, {"q", {{}, {}, {0, 1, 0}}}, {"mach", {{1, 0, 0}, {}, {}}}};
/// Axial force, normal force and pitching moment.
const Load loads[] = {{{1, 0, 0}, {}}, {{0, 0, 1}, {}}, {{}, {0, 1, 0}}};
Real of(const Load& weight, const Load& load) {
  return dot(weight.force, load.force) + dot(weight.moment, load.moment);
}

class AdjointTest : public testing::Test {
 protected:
  const Communicator comm;
  const BoxCase box{ramp_mesh(8), ramp_sides(), {.freeze_orders = 0}, comm};
  const Conditions<Real> conditions = steady_conditions({ramp_mach, 0, 0}, {}, gamma_air);
  SteadyFlow steady{box, conditions, 12};
  const DerivativeSettings settings{.orders = decades, .max_iterations = 600};

  std::vector<AdjointProblem> adjoint_problems() const {
    std::vector<AdjointProblem> out;
    for (const Load& load : loads)
      out.push_back({"load", std::vector<Load>(box.domain.patch_names.size(), load)});
    return out;
  }
};

TEST_F(AdjointTest, GivesTheDerivativesOfTheForwardSolves) {
  std::vector<SensitivityProblem> forward_problems;
  for (const auto& problem : problems) forward_problems.push_back({problem.name, problem.change});
  SensitivitySolver forward(steady.iteration, conditions, settings);
  const auto responses = forward.solve(forward_problems);
  const auto to_rate = forward.solve({{"alphadot", {}, responses[0].field}})[0];
  const auto to_second_rate = forward.solve({{"alphaddot", {}, to_rate.field}})[0];

  AdjointSolver backward(steady.iteration, conditions, settings);
  const auto adjoints = backward.solve(adjoint_problems());
  std::vector<AdjointProblem> chained;
  for (const auto& adjoint : adjoints) chained.push_back({"rate", {}, adjoint.field});
  const auto rates = backward.solve(chained);
  chained.clear();
  for (const auto& adjoint : rates) chained.push_back({"second rate", {}, adjoint.field});
  const auto second_rates = backward.solve(chained);

  for (std::size_t i = 0; i < std::size(loads); ++i) {
    EXPECT_LT(adjoints[i].relative_residual, 1.01e-10);
    const auto expect_same = [&](const Adjoint& adjoint, const ConditionsChange& change,
                                 const Sensitivity& response) {
      const Real expected = of(loads[i], response.total);
      EXPECT_NE(expected, 0);
      EXPECT_NEAR(product(adjoint.sensitivity, change), expected, as_one * std::abs(expected))
          << response.name << " of load " << i;
    };
    for (std::size_t j = 0; j < std::size(problems); ++j)
      expect_same(adjoints[i], problems[j].change, responses[j]);
    expect_same(rates[i], problems[0].change, to_rate);
    expect_same(second_rates[i], problems[0].change, to_second_rate);
  }
}

// The sensitivity error is a promise: after three decades the exact value lies within it, of every load and
// condition, and it is no idle one.
TEST_F(AdjointTest, SaysHowFarTheSensitivityMayBe) {
  const auto exact = AdjointSolver(steady.iteration, conditions, settings).solve(adjoint_problems());
  const auto rough = AdjointSolver(steady.iteration, conditions, {.orders = 3}).solve(adjoint_problems());
  for (std::size_t i = 0; i < rough.size(); ++i)
    for (const auto& problem : problems) {
      const Real value = product(rough[i].sensitivity, problem.change);
      const auto absolute = [](const Vec3& v) { return Vec3{std::abs(v.x), std::abs(v.y), std::abs(v.z)}; };
      const ConditionsChange size{absolute(problem.change.wind), absolute(problem.change.grid_velocity),
                                  absolute(problem.change.rotation)};
      const Real error = product(rough[i].sensitivity_error, size);
      EXPECT_LT(std::abs(value - product(exact[i].sensitivity, problem.change)), error) << problem.name;
      // The sensitivity to Mach number is a small one here, and no surer than those to other velocities.
      EXPECT_LT(error, (std::string_view(problem.name) == "mach" ? 0.15 : 0.05) * std::abs(value))
          << problem.name;
    }
}

/// The ramp's mesh with a bump that grows on the ramp and moves the points above along, and others aside.
Mesh with_bump(Real height) {
  Mesh mesh = ramp_mesh(8);
  for (Vec3& point : mesh.points) {
    const Real along = std::sin(3 * point.x + 1), above = 1 - point.z;
    point += height * Vec3{0.3 * above * point.z, 0, above * above * along};
  }
  return mesh;
}

// Steady flows on moved meshes, whose loads differ by what the adjoint says.
TEST_F(AdjointTest, GivesTheDerivativesByTheShape) {
  constexpr Real step = 1e-6, by_shape = 1e-5;
  AdjointSolver solver(steady.iteration, conditions, settings);
  const auto adjoints = solver.solve(adjoint_problems());
  const auto loads_with = [&](Real height) {
    const BoxCase moved(with_bump(height), ramp_sides(), {.freeze_orders = 0}, comm);
    return SteadyFlow(moved, conditions, 12).result.report.total;
  };
  const Load difference = (0.5 / step) * (loads_with(step) - loads_with(-step));
  const Mesh above = with_bump(1), middle = with_bump(0);
  for (std::size_t i = 0; i < std::size(loads); ++i) {
    const std::vector<Load> weights(box.domain.patch_names.size(), loads[i]);
    const auto by_points = solver.by_points(adjoints[i], weights);
    Real sum = 0;
    for (std::size_t point = 0; point < by_points.size(); ++point) {
      const auto id = static_cast<std::size_t>(box.domain.point_ids[point]);
      sum += dot(by_points[point], above.points[id] - middle.points[id]);
    }
    const Real expected = of(loads[i], difference);
    EXPECT_NEAR(comm.sum(sum), expected, by_shape * std::abs(expected)) << "load " << i;
  }
}

TEST_F(AdjointTest, EndsWhenItIsToldTo) {
  int asked = 0;
  AdjointSolver solver(steady.iteration, conditions, settings, [&] { return ++asked < 3; });
  EXPECT_TRUE(solver.solve(adjoint_problems()).empty());
  EXPECT_EQ(asked, 3);
}

}  // namespace
}  // namespace alphadot
