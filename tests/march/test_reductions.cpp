// How often the ranks wait for each other: the all-reduces that this program makes, counted between it and
// the MPI library. Expectations: the design, one for each residual that a driver looks at and none below it.
#include <gtest/gtest.h>
#include <mpi.h>
#include <cmath>

#include <memory>
#include <vector>

#include "derivatives/sensitivity.hpp"
#include "linear/krylov_basis.hpp"
#include "support/moving_box.hpp"
#include "support/ramp.hpp"
#include "support/steady_flow.hpp"

namespace {
int reductions = 0;
}

/// Takes the place of the library's function, which has this second name for the purpose.
extern "C" int MPI_Allreduce(const void* send, void* receive, int count, MPI_Datatype type, MPI_Op op,
                             MPI_Comm comm) {
  ++reductions;
  return PMPI_Allreduce(send, receive, count, type, op, comm);
}

namespace alphadot {
namespace {

using namespace testing_support;

template <class Work>
int reductions_of(const Work& work) {
  const int before = reductions;
  work();
  return reductions - before;
}

class ReductionsTest : public testing::Test {
 protected:
  const Communicator comm;
  const BoxCase box{ramp_mesh(6), ramp_sides(), {}, comm};
};

TEST_F(ReductionsTest, AreCounted) {
  EXPECT_EQ(reductions_of([&] { comm.sum(Real{1}); }), 1);
}

TEST_F(ReductionsTest, AreNotInResidualLinearisationAndSweeps) {
  const auto conditions = ramp_conditions();
  SteadyFlow steady(box, conditions, 1);
  EXPECT_EQ(reductions_of([&] {
              steady.iteration.evaluate(conditions, 2);
              steady.iteration.linearise(conditions, {.cfl = 10});
              steady.iteration.advance();
            }),
            0);
}

// Reduction are heard in the same iteration, on every rank.
TEST_F(ReductionsTest, AreOneInASteadyIterationWithItsReduction) {
  const auto conditions = ramp_conditions();
  ImplicitIteration iteration(box.discretization, comm,
                              std::make_unique<BlockLuSgs>(box.discretization, comm, 2), {});
  iteration.set_uniform(conditions.free_stream);
  Real asked = 0, heard = -1;
  iteration.take_along(
      {[&] { return std::vector<Real>{asked}; }, [&](std::span<const Real> sums) { heard = sums[0]; }});
  int before = 0;
  const auto observe = [&](const SteadyProgress& p) {
    if (p.iteration > 1) {
      EXPECT_EQ(reductions - before, 1) << "iteration " << p.iteration;
      EXPECT_EQ(heard, asked * comm.size());
    }
    before = reductions;
    asked = p.iteration;
    return true;
  };
  SteadySettings settings;
  settings.max_iterations = 10;
  const auto result = march_to_steady(iteration, conditions, settings, 2, observe);
  EXPECT_EQ(result.iterations, 10);
}

TEST_F(ReductionsTest, AreOneInAnInnerIteration) {
  const Motion motion = box_motion(MotionKind::plunge);
  MovingBox moving(channel(), {}, motion, TreatmentKind::field_velocity, motion.period() / 16);
  moving.start();
  StepReport step;
  EXPECT_EQ(reductions_of([&] { step = moving.advance(6); }), 7);  // one residual more than inner iterations
  EXPECT_EQ(step.inner_iterations, 6);
}

// A march of linear problems: one all-reduce an iteration for any number of them; at the end, one for the
// loads at all iterations of each.
TEST_F(ReductionsTest, AreOneInAnIterationOfLinearProblems) {
  const auto conditions = ramp_conditions();
  SteadyFlow steady(box, conditions, 6);
  const DerivativeSettings settings{.method = SensitivityMethod::march, .orders = 30, .max_iterations = 5};
  int before = 0;
  const auto go_on = [&] {
    if (before > 0) {
      EXPECT_EQ(reductions - before, 1);
    }
    before = reductions;
    return true;
  };
  SensitivitySolver(steady.iteration, conditions, settings, go_on)
      .solve({{"mach", {{1, 0, 0}, {}, {}}}, {"alpha", {{0, 0, 1}, {}, {}}}});
  EXPECT_GT(before, 0);
}

// One for all directions that GMRES adds at a time and one for all defects that they reduce; a further one
// for an image that lies nearly in the span of the others.
TEST_F(ReductionsTest, AreOneForNewDirectionsAndOneForTheDefects) {
  const auto cells = static_cast<std::size_t>(box.domain.owned_cells);
  const auto vector = [&](Real frequency) {
    std::vector<Primitive<Real>> out(cells);
    for (std::size_t cell = 0; cell < cells; ++cell)
      out[cell][0] = std::sin(frequency * static_cast<Real>(box.domain.cell_ids[static_cast<Index>(cell)]));
    return out;
  };
  KrylovBasis<Real> space(cells, 4, [&](std::vector<Real>& numbers) { comm.sum(numbers); });
  const auto added_with = [&](std::vector<std::vector<Primitive<Real>>> images) {
    const auto directions = images;
    std::vector<KrylovBasis<Real>::Candidate> candidates;
    for (std::size_t k = 0; k < images.size(); ++k) candidates.push_back({directions[k], images[k], {}});
    return reductions_of([&] { space.add(candidates); });
  };
  EXPECT_EQ(added_with({vector(1.3), vector(0.7)}), 1);
  auto defect = vector(0.4), other_defect = vector(0.3);
  std::vector<KrylovBasis<Real>::System> systems{{defect, {}, {}, 0}, {other_defect, {}, {}, 0}};
  EXPECT_EQ(reductions_of([&] { space.reduce(systems); }), 1);
  auto again = vector(1.3);
  again[0][0] += 0.01;
  EXPECT_EQ(added_with({again}), 2);
  EXPECT_EQ(space.size(), 3);
}

}  // namespace
}  // namespace alphadot
