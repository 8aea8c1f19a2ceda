// Walls that turn on a mesh that stays. Expected are Busemann's pressures on a turned plate, differences of
// steady flows with the walls turned further, and what the deforming mesh gives for the same turn.
#include "march/turning.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <optional>

#include "derivatives/adjoint.hpp"
#include "derivatives/sensitivity.hpp"
#include "derivatives/shape_change.hpp"
#include "support/ramp.hpp"
#include "support/steady_flow.hpp"

namespace alphadot {
namespace {

using namespace testing_support;

const Hinge hinge{{0.2, 0, 0.1}, {0, 1, 0}};

/// A box with one wall, its floor, that has turned.
struct TurnedFlow {
  TurnedFlow(const Mesh& mesh, const Hinge& about, Real angle, const Conditions<Real>& conditions)
      : box(mesh, ramp_sides(), {.freeze_orders = 0}, Communicator()) {
    box.discretization.set_turned_walls(turned_further(box.discretization, floor(), about, angle));
    steady.emplace(box, conditions, 12);
  }
  std::vector<std::string> floor() const { return {box.domain.patch_names[4]}; }
  const Load& load() const { return steady->result.report.total; }

  BoxCase box;
  std::optional<SteadyFlow> steady;
};

// Behind the wave from the plate's leading edge, in the inflow, the stream is uniform: transpiration leaves
// no error but that of the angle's third order in the series (Ackeret's and Busemann's terms, 0.04 %).
TEST(Turning, APlateFeelsCompressionAndExpansion) {
  constexpr Real m2 = ramp_mach * ramp_mach, b2 = m2 - 1, angle = 1 * radians_per_degree;
  const Mesh mesh = box_mesh({.cells = {10, 1, 8}, .lower = {0, 0, 0}, .upper = {1.25, 0.125, 1}});
  const auto conditions = steady_conditions({ramp_mach, 0, 0}, {}, gamma_air);
  for (const Real turn : {angle, -angle}) {  // of the flow; the hinge turns the nose down
    const TurnedFlow flow(mesh, {{0, 0, 0}, {0, 1, 0}}, -turn, conditions);
    const Real c1 = 2 / std::sqrt(b2), c2 = ((m2 - 2) * (m2 - 2) + gamma_air * m2 * m2) / (2 * b2 * b2);
    const Real expected = 0.5 * m2 * (c1 * turn + c2 * turn * turn) * 1.25 * 0.125;
    const Load& load = flow.load();
    EXPECT_NEAR(-load.force.z, expected * std::cos(turn), 2e-3 * std::abs(expected));
    EXPECT_NEAR(load.force.x, expected * std::sin(turn), 2e-3 * std::abs(expected * turn));
  }
}

class TurnedRampTest : public testing::Test {
 protected:
  static constexpr int cubes = 8;
  static constexpr Real turn = 2 * radians_per_degree, step = 1e-5;
  const Conditions<Real> conditions = steady_conditions({ramp_mach, 0, 0}, {}, gamma_air);
  const DerivativeSettings settings{.orders = 9, .max_iterations = 600};

  Load difference(const std::function<Load(Real)>& load) const {
    return 0.5 / step * (load(step) - load(-step));
  }
  Load turned_by(Real angle, const Conditions<Real>& in) const {
    return TurnedFlow(ramp_mesh(cubes), hinge, angle, in).load();
  }
  Sensitivity response(TurnedFlow& flow, const SensitivityProblem& problem) const {
    return SensitivitySolver(flow.steady->iteration, conditions, settings).solve({problem}).front();
  }
  HeldFlowChange change(TurnedFlow& flow, bool is_rate = false) const {
    return change_by_turn(flow.steady->iteration, conditions, [&](Real by) {
      return turned_further(flow.box.discretization, flow.floor(), hinge, is_rate ? 0 : by, is_rate ? by : 0);
    });
  }
  static SensitivityProblem problem_of(const HeldFlowChange& change) {
    SensitivityProblem out{"turn", {}};
    out.defect = change.residual;
    out.own_loads = change.loads;
    return out;
  }
  static void expect_equal(const Load& found, const Load& expected, Real tolerance) {
    for (const int axis : {0, 2})
      EXPECT_NEAR(found.force[axis], expected.force[axis], tolerance * norm(expected.force));
    EXPECT_NEAR(found.moment.y, expected.moment.y, tolerance * std::abs(expected.moment.y));
    EXPECT_GT(std::abs(expected.moment.y), 0.01);
  }
};

TEST_F(TurnedRampTest, SolvesAreDifferencesOfFlowsTurnedFurther) {
  TurnedFlow flow(ramp_mesh(cubes), hinge, turn, conditions);
  const auto turned = change(flow);
  expect_equal(response(flow, problem_of(turned)).total,
               difference([&](Real by) { return turned_by(turn + by, conditions); }), 1e-5);
}

// Of everything else about a flow with turned walls, too.
TEST_F(TurnedRampTest, OthersFeelTheTurnedWalls) {
  TurnedFlow flow(ramp_mesh(cubes), hinge, turn, conditions);
  expect_equal(response(flow, {"wind", {{0, 0, 1}, {}, {}}}).total, difference([&](Real by) {
                 return turned_by(turn, steady_conditions({ramp_mach, 0, by}, {}, gamma_air));
               }),
               1e-5);
  expect_equal(response(flow, {"q", {{}, {}, {0, 1, 0}}}).total, difference([&](Real by) {
                 return turned_by(turn, steady_conditions({ramp_mach, 0, 0}, {}, gamma_air, {0, by, 0}));
               }),
               1e-5);
}

// The adjoint of a load says the same of the wind, of rates and of a turn as the solves for these.
TEST_F(TurnedRampTest, AdjointsFeelTheTurnedWalls) {
  TurnedFlow flow(ramp_mesh(cubes), hinge, turn, conditions);
  const Load weight{{0.3, 0, 1}, {0, -0.7, 0}};
  const std::vector<Load> weights(flow.box.domain.patch_names.size(), weight);
  const auto turned = change(flow);
  AdjointSolver solver(flow.steady->iteration, conditions, settings);
  solver.follow(turned.residual);
  const auto adjoint = solver.solve({{"load", weights}}).front();
  const auto weighted = [&](const Load& load) {
    return dot(weight.force, load.force) + dot(weight.moment, load.moment);
  };
  const auto expect = [&](Real found, Real expected) {
    EXPECT_NEAR(found, expected, 1e-6 * std::abs(expected));
    EXPECT_GT(std::abs(expected), 0.01);
  };
  expect(adjoint.sensitivity.wind.z, weighted(response(flow, {"wind", {{0, 0, 1}, {}, {}}}).total));
  expect(adjoint.sensitivity.rotation.y, weighted(response(flow, {"q", {{}, {}, {0, 1, 0}}}).total));
  Load own = total_of(turned.loads);
  auto numbers = numbers_of(std::span(&own, 1));
  flow.box.comm.sum(numbers);
  own = loads_of(numbers).front();
  expect(adjoint.products.front() + weighted(own), weighted(response(flow, problem_of(turned)).total));
}

// A wall that turns at a rate is one that a grid turns at that rate past gas that stays where it is: on a
// floor whose hinge lies in its plane both say the same of the wall.
TEST_F(TurnedRampTest, ARateIsTheSpeedOfTheWall) {
  TurnedFlow flow(ramp_mesh(cubes), hinge, 0, conditions);
  const auto by_rate = change(flow, true);
  const Subdomain& domain = flow.box.domain;
  Residual residual(flow.box.discretization, flow.box.comm);
  const auto pressures = [&](Real rate) {
    FaceSpeeds speeds{std::vector<Real>(domain.faces.size(), 0),
                      std::vector<Real>(domain.boundary_faces.size(), 0)};
    for (std::size_t i = 0; i < speeds.boundary.size(); ++i)
      if (domain.boundary_faces[i].patch == 4)
        speeds.boundary[i] = rate * dot(cross(hinge.axis, domain.boundary_center[i] - hinge.point),
                                        1 / norm(domain.boundary_normal[i]) * domain.boundary_normal[i]);
    auto moving = conditions;
    moving.face_speeds = &speeds;
    std::vector<Conserved<Real>> values(flow.box.cells());
    residual.evaluate(flow.steady->iteration.flow(), moving, 2, values);
    return total_of(wall_loads(flow.box.discretization, residual, {}));
  };
  const Load expected = 0.5 / step * (pressures(step) - pressures(-step)), found = total_of(by_rate.loads);
  EXPECT_NEAR(found.force.z, expected.force.z, 1e-6 * norm(expected.force));
  EXPECT_NEAR(found.moment.y, expected.moment.y, 1e-6 * std::abs(expected.moment.y));
}

// To what the mesh leaves: the shock from the ramp's foot moves with it.
TEST_F(TurnedRampTest, IsCloseToWhatTheDeformingMeshGives) {
  TurnedFlow flow(ramp_mesh(cubes), hinge, 0, conditions);
  const auto turned = change(flow);
  const auto moved = change_by_displacement(
      flow.steady->iteration, conditions,
      deflection(flow.box.discretization, flow.floor(), hinge, flow.box.comm).displacement, false);
  expect_equal(response(flow, problem_of(turned)).total, response(flow, problem_of(moved)).total, 0.05);
}

}  // namespace
}  // namespace alphadot
