// A uniform stream is an exact solution, whatever the grid seems to do. On axes that turn, its components
// turn the other way: the residual is the momentum source V rho Omega x u, no more and no less.
#include <gtest/gtest.h>

#include <tuple>

#include "space/residual.hpp"
#include "support/box_case.hpp"

namespace alphadot {
namespace {

using namespace testing_support;

// Fluxes of order one through faces of area 0.1 cancel in every cell.
constexpr Real round_off = 1e-12;

class FreeStream : public testing::TestWithParam<std::tuple<FluxKind, int>> {
 protected:
  SpaceSettings space() const {
    return {.flux = std::get<0>(GetParam()), .order = order(), .limiter = LimiterKind::venkatakrishnan};
  }
  int order() const { return std::get<1>(GetParam()); }

  /// Residual of the uniform stream on a box.
  std::vector<Conserved<Real>> residual(const BoxCase& box, const Conditions<Real>& conditions) const {
    FlowField<Real> flow(box.domain, box.comm);
    fill(flow, box.domain, [&](const Vec3&, GlobalIndex) { return conditions.free_stream; });
    std::vector<Conserved<Real>> out(box.cells());
    Residual(box.discretization, box.comm).evaluate(flow, conditions, order(), out);
    return out;
  }
  static void expect_cell(const Conserved<Real>& found, const Conserved<Real>& expected) {
    for (int i = 0; i < 5; ++i) EXPECT_NEAR(found[i], expected[i], round_off);
  }

  const Communicator comm;
  const Mesh mesh = small_box();
  const Vec3 winds[4] = {{0, 0, 0}, {0.4, 0.2, -0.1}, wind_velocity(1.58, 0.1, 0.05), {-3, 0.5, 1}};
};
INSTANTIATE_TEST_SUITE_P(Schemes, FreeStream,
                         testing::Combine(testing::ValuesIn(all_fluxes), testing::Values(1, 2)),
                         [](const auto& scheme) {
                           return name_of(std::get<0>(scheme.param)) +
                                  std::to_string(std::get<1>(scheme.param));
                         });

TEST_P(FreeStream, StaysOnAGridAtRestOrInTranslation) {
  const BoxCase box(mesh, open_box(), space(), comm);
  for (const Vec3& wind : winds)
    for (const Vec3& velocity : {Vec3{}, Vec3{0, 0, -0.3}, Vec3{2, -0.5, 0.7}, wind}) {
      const auto found = residual(box, {free_stream(wind, gamma_air), {velocity, {}, {}}});
      for (const auto& value : found) expect_cell(value, {});
    }
}

TEST_P(FreeStream, RunsAlongWalls) {
  const BoxCase box(mesh, channel(), space(), comm);
  for (const Real mach : {0.3, 1.58}) {
    for (const Real grid : {0.0, -0.7}) {
      const auto found = residual(box, {free_stream(Vec3{mach, 0, 0}, gamma_air), {{grid, 0, 0}, {}, {}}});
      for (const auto& value : found) expect_cell(value, {});
    }
  }
}

// Face velocities at centroids cancel over closed cells for rotations too; what is left is the source.
TEST_P(FreeStream, LeavesTheSourceOfTurningAxes) {
  const BoxCase box(mesh, open_box(), space(), comm);
  const auto grid = tumbling_grid();
  for (const Vec3& wind : winds) {
    const auto found = residual(box, {free_stream(wind, gamma_air), grid});
    for (Index cell = 0; cell < box.domain.owned_cells; ++cell) {
      const Vec3 source = box.domain.volume[cell] * cross(grid.rotation, wind);
      expect_cell(found[cell], {{0, source.x, source.y, source.z, 0}});
    }
  }
}

// Steady rotation: a stream that turns with the axes is at rest along them.
TEST_P(FreeStream, StaysWhenItTurnsWithTheAxes) {
  const BoxCase box(mesh, open_box(), space(), comm);
  for (const Vec3& wind : winds) {
    const auto found = residual(box, {free_stream(wind, gamma_air), tumbling_grid(), wind});
    for (const auto& value : found) expect_cell(value, {});
  }
}

// The whole identity V dU/dt + R(U) = 0 for a stream seen from a pitching body, at moments of its cycle. The
// central difference in time errs by step^2 omega^3 / 6 times V, below 1e-10 here.
TEST_P(FreeStream, SolvesTheEquationsOnPitchingAxes) {
  const BoxCase box(mesh, open_box(), space(), comm);
  MotionSettings settings;
  settings.kind = MotionKind::pitch;
  settings.amplitude = 5;
  settings.reduced_frequency = 0.1;
  const Motion motion(settings, {.mach = 1.58, .alpha = 2, .beta = 1, .gamma = gamma_air}, 1);
  const auto conditions = [&](Real time) {
    return field_velocity_conditions(motion.at(time), motion.wind(), {0.4, -0.6, 0.2}, gamma_air);
  };
  constexpr Real step = 1e-4;
  for (int i = 0; i < 4; ++i) {
    const Real time = (0.07 + 0.25 * i) * motion.period();
    const auto rate = (0.5 / step) * (conserved(conditions(time + step).free_stream, gamma_air) -
                                      conserved(conditions(time - step).free_stream, gamma_air));
    const auto found = residual(box, conditions(time));
    for (Index cell = 0; cell < box.domain.owned_cells; ++cell) {
      const auto balance = box.domain.volume[cell] * rate + found[cell];
      for (int k = 0; k < 5; ++k) EXPECT_NEAR(balance[k], 0, 1e-10);
    }
  }
}

}  // namespace
}  // namespace alphadot
