// The time-accurate march. Expectations: a uniform stream solves the equations exactly; seen from axes that
// pitch, its components turn, and second-order backward differences follow them with an error of second
// order.
#include "solver/dual_time.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "box_case.hpp"
#include "solver/block_lu_sgs.hpp"

namespace alphadot {
namespace {

using namespace testing_support;

const Vec3 axis_point{0.4, -0.6, 0.2};
constexpr InnerTolerance tight{.share = 0, .amplitude = 1, .max_iterations = 8};

Motion motion_of(MotionKind kind) {
  MotionSettings settings;
  settings.kind = kind;
  settings.amplitude = 5;
  settings.reduced_frequency = 0.3;
  return Motion(settings, {.mach = 1.58, .alpha = 2, .beta = 0, .gamma = gamma_air}, 1);
}

struct Pitching : testing::TestWithParam<int> {
  /// March through three quarters of a period of a motion in an open box; largest difference from the stream
  /// that the attitude at the end of each step asks for.
  Real largest_error(MotionKind kind, int steps_per_period) {
    const Communicator comm;
    const BoxCase box(small_box(), open_box(), {.order = GetParam()}, comm);
    const Motion motion = motion_of(kind);
    ImplicitIteration iteration(box.discretization, comm,
                                std::make_unique<BlockLuSgs>(box.discretization, comm, 8), {});
    iteration.set_uniform(free_stream(motion.wind(), gamma_air));
    const Real step = motion.period() / steps_per_period;
    DualTime march(iteration, motion, axis_point, step, {});
    Real worst = 0;
    for (int i = 1; i <= 3 * steps_per_period / 4; ++i) {
      const StepReport report = march.advance(tight);
      EXPECT_EQ(report.step, i);
      EXPECT_NEAR(report.time, i * step, 1e-12);
      EXPECT_EQ(report.attitude.alpha, motion.at(report.time).alpha);
      if (4 * i < steps_per_period)
        continue;  // the flow crosses the box in a fifth of a period: the start is past
      const auto exact =
          field_velocity_conditions(motion.at(report.time), motion.wind(), axis_point, gamma_air).free_stream;
      for (Index cell = 0; cell < box.domain.owned_cells; ++cell)
        for (int k = 0; k < 5; ++k) worst = std::max(worst, std::abs(iteration.flow()[cell][k] - exact[k]));
    }
    return comm.max(worst);
  }
};
INSTANTIATE_TEST_SUITE_P(Orders, Pitching, testing::Values(1, 2));

TEST_P(Pitching, IsFollowedWithSecondOrderInTime) {
  Real e0 = 0;
  for (int n : {16, 32, 64, 128}) {
    Real e = largest_error(MotionKind::pitch, n);
    printf("%d %g %g\n", n, e, e0 / e);
    e0 = e;
  }
}

// Seen from a body that plunges, the stream's absolute velocity does not change at all.
TEST_P(Pitching, LeavesAStreamAloneInPlunge) {
  EXPECT_LT(largest_error(MotionKind::plunge, 16), 1e-13);
}

}  // namespace
}  // namespace alphadot
