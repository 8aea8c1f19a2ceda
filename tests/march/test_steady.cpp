// The steady state belongs to the equations alone: not to the number of ranks, nor to the way it was marched
// to.
#include <gtest/gtest.h>

#include "linear/lu_sgs.hpp"
#include "support/ramp.hpp"
#include "support/steady_flow.hpp"

namespace alphadot {
namespace {

using namespace testing_support;

constexpr int cubes = 8;
constexpr Real orders = 11;  // leaves 1e-11 of the first residual

std::vector<Five<Real>> states(const SteadyFlow& steady, const BoxCase& box) {
  return by_cell_id(box.domain, box.comm, steady.iteration.flow().values());
}

void expect_same(const std::vector<Five<Real>>& found, const std::vector<Five<Real>>& expected,
                 Real tolerance) {
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t cell = 0; cell < found.size(); ++cell)
    for (int i = 0; i < 5; ++i) EXPECT_NEAR(found[cell][i], expected[cell][i], tolerance) << "cell " << cell;
}

class Steady : public testing::TestWithParam<FluxKind> {
 protected:
  const Communicator comm, self{MPI_COMM_SELF};
  const Mesh mesh = ramp_mesh(cubes);
  const SpaceSettings space{.flux = GetParam(), .freeze_orders = 0};  // frozen factors remember the march
};
INSTANTIATE_TEST_SUITE_P(Fluxes, Steady, testing::ValuesIn(all_fluxes),
                         [](const auto& kind) { return name_of(kind.param); });

TEST_P(Steady, IsReachedToTenDecadesAndIsTheSameOnAnyNumberOfRanks) {
  const BoxCase cut(mesh, ramp_sides(), space, comm), whole(mesh, ramp_sides(), space, self);
  const SteadyFlow parallel(cut, ramp_conditions(), orders), serial(whole, ramp_conditions(), orders);
  for (const auto* steady : {&parallel, &serial}) {
    EXPECT_EQ(steady->result.status, RunStatus::converged);
    EXPECT_GE(steady->result.orders, orders);
  }
  expect_same(states(parallel, cut), states(serial, whole), 1e-9);
  EXPECT_NEAR(parallel.result.report.total.force.x, serial.result.report.total.force.x, 1e-11);
  EXPECT_NEAR(parallel.result.report.total.moment.y, serial.result.report.total.moment.y, 1e-11);
}

// The same flow past a body that moves against still air.
TEST_P(Steady, IsTheSameInTheFrameOfTheAir) {
  const BoxCase box(mesh, ramp_sides(), space, comm);
  const SteadyFlow blown(box, ramp_conditions(), orders);
  const SteadyFlow moved(box, {free_stream(Vec3{}, gamma_air), {{-ramp_mach, 0, 0}, {}, {}}}, orders);
  auto expected = states(blown, box);
  for (auto& w : expected) w[1] -= ramp_mach;
  expect_same(states(moved, box), expected, 1e-9);
}

// The block scheme brings supersonic flow to rest by itself. The scalar one is slow on this mesh, so that
// Newton-Krylov steps follow, unless they are not allowed.
TEST_P(Steady, DoesNotDependOnTheImplicitScheme) {
  const BoxCase box(mesh, ramp_sides(), space, comm);
  const SteadyFlow block(box, ramp_conditions(), orders,
                         std::make_unique<BlockLuSgs>(box.discretization, comm, 6));
  EXPECT_EQ(block.krylov_steps, 0);
  const auto scalar = [&](int directions) {
    return std::make_unique<SteadyFlow>(box, ramp_conditions(), orders,
                                        std::make_unique<LuSgs>(box.discretization, comm), directions);
  };
  const auto alone = scalar(0), newton = scalar(20);
  EXPECT_EQ(alone->krylov_steps, 0);
  EXPECT_GT(newton->krylov_steps, 0);
  EXPECT_LT(newton->result.iterations, alone->result.iterations / 2);
  for (const auto* steady : {alone.get(), newton.get()}) {
    EXPECT_EQ(steady->result.status, RunStatus::converged);
    expect_same(states(*steady, box), states(block, box), 1e-9);
  }
}

// Supersonic flow along x, in which a forward pass carries a disturbance to the end. At the first order,
// whose derivative the blocks are: there the march waits for its linear solves alone.
TEST_P(Steady, IsReachedSoonerByPassesDownstream) {
  auto first_order = space;
  first_order.order = 1;
  const BoxCase box(ramp_mesh(16), ramp_sides(), first_order, comm);
  const auto march = [&](PassOrder order) {
    return SteadyFlow(box, ramp_conditions(), orders,
                      std::make_unique<BlockLuSgs>(box.discretization, comm, 2, order));
  };
  const SteadyFlow alternating = march(PassOrder::alternating), downstream = march(PassOrder::downstream);
  expect_same(states(downstream, box), states(alternating, box), 1e-9);
  EXPECT_LT(downstream.result.iterations, alternating.result.iterations);
}

// Subsonic flow, in which the block scheme alone takes several times as many iterations.
TEST_P(Steady, IsReachedInSubsonicFlowToo) {
  const BoxCase box(mesh, ramp_sides(), space, comm);
  const Conditions<Real> conditions{free_stream(Vec3{0.5, 0, 0}, gamma_air), {}};
  constexpr Real fewer_orders = 8;
  const auto march = [&](int directions) {
    return std::make_unique<SteadyFlow>(
        box, conditions, fewer_orders, std::make_unique<BlockLuSgs>(box.discretization, comm, 1), directions);
  };
  const auto newton = march(20), alone = march(0);
  for (const auto* steady : {newton.get(), alone.get()})
    EXPECT_EQ(steady->result.status, RunStatus::converged);
  EXPECT_GT(newton->krylov_steps, 0);
  EXPECT_LT(newton->result.iterations, alone->result.iterations);
  expect_same(states(*newton, box), states(*alone, box), 1e-6);
}

// Where there is nothing to do, nothing is done: a uniform stream in an open box is steady.
TEST_P(Steady, LeavesAUniformStreamAlone) {
  const BoxCase box(small_box(), open_box(), space, comm);
  const Conditions<Real> conditions{free_stream(Vec3{1.5, 0.2, -0.1}, gamma_air), {}};
  ImplicitIteration iteration(box.discretization, comm,
                              std::make_unique<BlockLuSgs>(box.discretization, comm, 2), {});
  iteration.set_uniform(conditions.free_stream);
  iteration.evaluate(conditions, 2);
  EXPECT_LT(iteration.report().density_residual, 1e-15);
  iteration.linearise(conditions, {.cfl = 10});
  iteration.advance();
  for (Index cell = 0; cell < box.domain.owned_cells; ++cell)
    for (int i = 0; i < 5; ++i) EXPECT_NEAR(iteration.flow()[cell][i], conditions.free_stream[i], 1e-13);
}

// Nor is there anything to wait for: round-off does not fall by decades.
TEST_P(Steady, IsFoundAtOnceWhereTheFlowIsSteadyAlready) {
  const BoxCase box(small_box(), open_box(), space, comm);
  const Conditions<Real> conditions{free_stream(Vec3{1.5, 0.2, -0.1}, gamma_air), {}};
  ImplicitIteration iteration(box.discretization, comm,
                              std::make_unique<BlockLuSgs>(box.discretization, comm, 2), {});
  iteration.set_uniform(conditions.free_stream);
  const auto result = march_to_steady(iteration, conditions, {.max_iterations = 10, .orders = orders}, 2,
                                      [](const SteadyProgress&) { return true; });
  EXPECT_EQ(result.status, RunStatus::converged);
}

TEST_P(Steady, TakesBackAStep) {
  const BoxCase box(mesh, ramp_sides(), space, comm);
  ImplicitIteration iteration(box.discretization, comm,
                              std::make_unique<BlockLuSgs>(box.discretization, comm, 2), {});
  iteration.set_uniform(ramp_conditions().free_stream);
  iteration.evaluate(ramp_conditions(), 2);
  const auto before = iteration.report();
  iteration.linearise(ramp_conditions(), {.cfl = 10});
  iteration.advance();
  Real moved = 0;
  for (const auto& w : iteration.flow().values()) moved = std::max(moved, std::abs(w[4] - 1 / gamma_air));
  EXPECT_GT(comm.max(moved), 0.01);
  iteration.undo();
  for (Index cell = 0; cell < box.domain.owned_cells; ++cell)
    for (int i = 0; i < 5; ++i)
      EXPECT_NEAR(iteration.flow()[cell][i], ramp_conditions().free_stream[i], 1e-15);
  iteration.evaluate(ramp_conditions(), 2);
  EXPECT_NEAR(iteration.report().density_residual, before.density_residual, 1e-14);
}

TEST_P(Steady, ReportsWhatIsNotANumber) {
  const BoxCase box(mesh, ramp_sides(), space, comm);
  ImplicitIteration iteration(box.discretization, comm,
                              std::make_unique<BlockLuSgs>(box.discretization, comm, 2), {});
  iteration.set_uniform(ramp_conditions().free_stream);
  iteration.evaluate(ramp_conditions(), 1);
  EXPECT_TRUE(iteration.report().physical);
  if (comm.rank() == comm.size() - 1) iteration.flow()[0][4] = -1;
  iteration.evaluate(ramp_conditions(), 1);
  EXPECT_FALSE(iteration.report().physical) << "a negative pressure has no sound speed";
}

}  // namespace
}  // namespace alphadot
