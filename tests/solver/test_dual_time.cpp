// The time-accurate march. Expectations: a uniform stream solves the equations exactly; seen from axes that
// pitch, its components turn, and second-order backward differences follow them with an error of second
// order.
#include "solver/dual_time.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "box_case.hpp"
#include "solver/block_lu_sgs.hpp"

namespace alphadot {
namespace {

using namespace testing_support;

const Vec3 axis_point{0.4, -0.6, 0.2};

Motion motion_of(MotionKind kind) {
  MotionSettings settings;
  settings.kind = kind;
  settings.amplitude = 5;
  settings.reduced_frequency = 0.3;
  return Motion(settings, {.mach = 1.58, .alpha = 2, .beta = 0, .gamma = gamma_air}, 1);
}

/// A part of the march, in periods.
struct Window {
  Real begin, end;
};
// The pitch rate sets in at t = 0. The flow clears the box of what comes of that within half a period (its
// slowest wave runs at Mach 0.58 over a length of 2).
constexpr Window start{0, 0.25}, later{1, 1.25};

/// Parameter: order in space.
class UniformStream : public testing::TestWithParam<int> {
 protected:
  /// March along a motion in an open box; largest difference within the window from the stream that the
  /// attitude at the end of each step asks for.
  Real largest_error(MotionKind kind, int steps_per_period, const Window& window) {
    const Communicator comm;
    const BoxCase box(small_box(), open_box(), {.order = GetParam()}, comm);
    const Motion motion = motion_of(kind);
    ImplicitIteration iteration(box.discretization, comm,
                                std::make_unique<BlockLuSgs>(box.discretization, comm, 8), {});
    iteration.set_uniform(free_stream(motion.wind(), gamma_air));
    const Real step = motion.period() / steps_per_period;
    DualTime march(iteration, motion, axis_point, step, {});
    Real worst = 0;
    for (int i = 1; i <= window.end * steps_per_period; ++i) {
      const StepReport report = march.advance({.share = 0, .amplitude = 1, .max_iterations = 10});
      EXPECT_EQ(report.step, i);
      EXPECT_NEAR(report.time, i * step, 1e-12);
      EXPECT_EQ(report.attitude.alpha, motion.at(report.time).alpha);
      if (i < window.begin * steps_per_period) continue;
      const auto exact =
          field_velocity_conditions(motion.at(report.time), motion.wind(), axis_point, gamma_air).free_stream;
      for (Index cell = 0; cell < box.domain.owned_cells; ++cell)
        for (int k = 0; k < 5; ++k) worst = std::max(worst, std::abs(iteration.flow()[cell][k] - exact[k]));
    }
    return comm.max(worst);
  }
  /// By how much halving the step divides the error.
  Real gain(const Window& window) {
    return largest_error(MotionKind::pitch, 16, window) / largest_error(MotionKind::pitch, 32, window);
  }
};
INSTANTIATE_TEST_SUITE_P(OrdersInSpace, UniformStream, testing::Values(1, 2));

// Second order: four, of which a tenth is allowed for higher terms. First order would give two.
TEST_P(UniformStream, IsFollowedWithSecondOrderOncePitchingHasSetIn) {
  EXPECT_GT(gain(later), 3.6);
}

// Motions set in at t = 0, with a jump of rate or of velocity. Backward differences that take the state
// before as given lag by half a step ever after, an error of first order; it would be counted in full in the
// integral of a step response.
TEST_P(UniformStream, IsFollowedWithSecondOrderFromTheStart) {
  EXPECT_GT(gain(start), 3.6);
}

// Seen from a body that plunges, the stream's absolute velocity does not change at all.
TEST_P(UniformStream, IsLeftAloneInPlunge) {
  EXPECT_LT(largest_error(MotionKind::plunge, 16, {0, 1}), 1e-13);
}

}  // namespace
}  // namespace alphadot
