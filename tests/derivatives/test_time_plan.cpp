// When a step's response is over: sound that runs against a stream of speed V = M a is carried along at V -
// a.
#include "derivatives/time_plan.hpp"

#include <gmock/gmock.h>

namespace alphadot {
namespace {

Configuration box(Real length, Real span) {
  Configuration out;
  out.body = {{2, 0, 0}, {2 + length, span, 0}};
  out.body_length = std::max(length, span);
  return out;
}

std::string shortfall(Real mach, Real duration, int steps, const Configuration& configuration,
                      MotionKind kind = MotionKind::step_alpha) {
  Case c;
  c.freestream.mach = mach;
  c.motion.kind = kind;
  c.unsteady.duration = duration;
  c.unsteady.steps = steps;
  return response_shortfall(c, configuration);
}

TEST(Response, IsOverWhenTheSlowestWaveHasPassed) {
  // At Mach 2 it takes l / (V - a) = 2 l / V: t* = 2 V t / l = 4, a span of ten lengths or not.
  for (const Real span : {0.5, 10.0}) {
    EXPECT_EQ(shortfall(2, 4, 12, box(1, span)), "");
    EXPECT_THAT(shortfall(2, 3.9, 40, box(1, span)), testing::HasSubstr("the response is not over"));
    EXPECT_THAT(shortfall(2, 40, 119, box(1, span)), testing::HasSubstr("set unsteady.steps to 120"));
  }
  EXPECT_EQ(shortfall(2, 8, 24, box(1, 1), MotionKind::ramp_alpha), "");  // half of a ramp is its start
  EXPECT_THAT(shortfall(2, 7, 70, box(1, 1), MotionKind::ramp_alpha), testing::HasSubstr("half of"));
  // Below the speed of sound it runs ahead at a - V, also along the span.
  EXPECT_EQ(shortfall(0.8, 8, 12, box(1, 1)), "");
  EXPECT_THAT(shortfall(0.8, 8, 100, box(1, 3)), testing::HasSubstr("t* = 24"));
  EXPECT_EQ(shortfall(2, 1, 1, box(1, 1), MotionKind::plunge), "");
  EXPECT_THAT(shortfall(1.9, 4, 40, box(1.2345, 1)), testing::HasSubstr("t* = 5.212"));  // and that will do
  EXPECT_EQ(shortfall(1.9, 5.212, 40, box(1.2345, 1)), "");
}

}  // namespace
}  // namespace alphadot
