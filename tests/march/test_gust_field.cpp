// Gusts on a mesh. Expectations: a gust that is at rest in the undisturbed air leaves it alone wherever its
// front is, and so does one that comes at another speed; within a gust of no end a wall feels the body's own
// sinking; conservation.
#include "march/gust_field.hpp"

#include <gtest/gtest.h>

#include "support/moving_box.hpp"

namespace alphadot {
namespace {

using namespace testing_support;

Motion held(Real alpha = 2) {
  return Motion({}, {.mach = 1.58, .alpha = alpha, .beta = 1, .gamma = gamma_air}, 1);
}

GustSettings settings_of(GustKind kind, Real speed = 1, Real front = -0.7) {
  GustSettings out;
  out.kind = kind;
  out.velocity = 0.05;
  out.length = 1.3;
  out.front = front;
  out.speed = speed;
  return out;
}

std::unique_ptr<GustField> field_of(const GustSettings& settings, const Discretization& discretization) {
  return std::make_unique<GustField>(Gust(settings, 1.58, {{0, 0.2, 3}, {0.01, 0.04, 0}}), discretization);
}

TEST(GustField, LeavesTheUndisturbedStreamAlone) {
  const Motion motion = held();
  for (const auto kind : {GustKind::sharp, GustKind::one_minus_cosine, GustKind::harmonic, GustKind::table})
    for (const Real speed : {1.0, 0.0, 0.6}) {
      MovingBox box(open_box(), {}, motion, TreatmentKind::field_velocity, 0.15);
      box.march = std::make_unique<DualTime>(
          box.iteration, motion, box_axis_point, 0.15, Load{},
          std::make_unique<FieldVelocity>(motion, box_axis_point, 0.15, box.discretization,
                                          field_of(settings_of(kind, speed), box.discretization)));
      for (int i = 0; i < 5; ++i) {
        box.advance(4);
        EXPECT_LT(box.distance_from(free_stream(motion.wind(), gamma_air)), 1e-12) << word_of(kind);
      }
    }
}

// Where its velocity is the same everywhere it is that of a body that moves the other way.
TEST(GustField, IsAFieldVelocityWhereItDoesNotVary) {
  const Motion motion = held();
  MovingBox box(channel(), {}, motion, TreatmentKind::field_velocity, 0.15);
  const auto cells = static_cast<std::size_t>(box.domain.owned_cells);
  fill(box.iteration.flow(), box.domain, rough_state);
  auto field = field_of(settings_of(GustKind::sharp, 1, 100), box.discretization);
  auto gust = field_velocity_conditions(motion.at(0), motion.wind(), box_axis_point, gamma_air);
  field->enter(gust, motion.at(0), {}, motion.wind().x, 0);
  box.iteration.evaluate(gust, 2);
  const std::vector<Conserved<Real>> in_gust(box.iteration.residual_values().begin(),
                                             box.iteration.residual_values().end());
  Attitude sinking;
  sinking.velocity = {0, 0, -1.58 * 0.05};
  box.iteration.evaluate(field_velocity_conditions(sinking, motion.wind(), box_axis_point, gamma_air), 2);
  for (std::size_t cell = 0; cell < cells; ++cell)
    for (int i = 0; i < 5; ++i) EXPECT_NEAR(in_gust[cell][i], box.iteration.residual_values()[cell][i], 1e-9);
}

// The source against the derivation by hand, in a flow that is uniform but not the stream: u = u0 + d. What
// the faces let through then sums to d.n times nothing, and rho d_x dg/dx and its work are left. A table that
// is straight over the box makes the slope the same everywhere.
TEST(GustField, HasTheSourcesOfTheSplitVelocity) {
  const Motion motion = held();
  MovingBox box(open_box(), {}, motion, TreatmentKind::field_velocity, 0.15);
  const Real slope = 1.58 * 0.002;
  GustSettings settings = settings_of(GustKind::table, 1, 50);
  GustField field(Gust(settings, 1.58, {{0, 100}, {0, 0.2}}), box.discretization);
  auto conditions = field_velocity_conditions(motion.at(0), motion.wind(), box_axis_point, gamma_air);
  field.enter(conditions, motion.at(0), {}, motion.wind().x, 0);
  const Vec3 u = motion.wind() + Vec3{0.1, 0.03, -0.02};
  const Primitive<Real> state{{1.2, u.x, u.y, u.z, 0.8}};
  // The slope is of the distance behind the front, against x.
  const Real push = 1.2 * 0.1 * -slope;
  for (Index cell = 0; cell < box.domain.owned_cells; ++cell) {
    const auto number = static_cast<std::size_t>(cell);
    const Real volume = box.domain.volume[number];
    auto found = gust_source(state, conditions, number, gamma_air);
    EXPECT_NEAR(conditions.gust->divergence[number], 0, 1e-10);
    const Five<Real> expected{{0, 0, 0, volume * push, volume * push * u.z}};
    for (int i = 0; i < 5; ++i) EXPECT_NEAR(found[i], expected[i], 1e-9 * volume + 1e-10) << i;
  }
}

}  // namespace
}  // namespace alphadot
