// Order of accuracy in space, measured on an exact solution of the unsteady Euler equations: an isentropic
// vortex that a uniform stream carries along. It decays like exp(-r^2), so that the box's far field sees the
// stream alone.
//
// With v = kappa r exp(1 - r^2) around the axis, radial equilibrium rho v^2 / r = dp/dr at constant entropy
// integrates to a^2 = 1 - (gamma - 1) kappa^2 / 4 exp(2 - 2 r^2). The box has the same thickness on every
// mesh: in a slab that thins with the spacing, errors that differ from layer to layer would not average out.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "support/box_case.hpp"
#include "support/runge_kutta.hpp"

namespace alphadot {
namespace {

using namespace testing_support;

constexpr Real half_width = 4;
constexpr Real duration = 0.6;
const Vec3 stream{0.8, 0.5, 0};
const Vec3 frame{0.7, -1.3, 0.4};               // velocity of the moving frames
const Vec3 start = (-0.5 * duration) * stream;  // the vortex passes the middle of the box half-way

Primitive<Real> vortex(const Vec3& x, const Vec3& axis, const Vec3& frame_velocity) {
  constexpr Real kappa = 0.25;
  const Vec3 r{x.x - axis.x, x.y - axis.y, 0};
  const Real swirl = kappa * std::exp(1 - dot(r, r));
  const Real a2 = 1 - (gamma_air - 1) / 4 * swirl * swirl;
  const Real rho = std::pow(a2, 1 / (gamma_air - 1));
  const Vec3 u = stream + frame_velocity + swirl * Vec3{-r.y, r.x, 0};
  return {{rho, u.x, u.y, u.z, rho * a2 / gamma_air}};
}

/// n x n x n / 8 cubes between symmetry planes, cut into tetrahedra; all points but those on the sides are
/// moved by up to 0.12 of the spacing (on the planes, along them).
Mesh shaken_slab(int n) {
  const Real spacing = 2 * half_width / n, thickness = 1;
  Mesh mesh = box_mesh({.cells = {n, n, n / 8},
                        .lower = {-half_width, -half_width, 0},
                        .upper = {half_width, half_width, thickness}});
  std::mt19937 generator(3);
  const auto shift = [&] { return 0.12 * spacing * (2 * (generator() / 4294967295.0) - 1); };
  const Real outermost = half_width - 0.5 * spacing;
  for (Vec3& point : mesh.points) {
    const Vec3 moved = point + Vec3{shift(), shift(), shift()};
    if (std::max(std::abs(point.x), std::abs(point.y)) > outermost) continue;
    const bool between_planes = point.z > 0.5 * spacing && point.z < thickness - 0.5 * spacing;
    point = {moved.x, moved.y, between_planes ? moved.z : point.z};
  }
  return mesh;
}

/// The vortex on one mesh, in a frame in which everything, grid included, moves by `frame_velocity` more.
struct VortexRun {
  VortexRun(int n, const SpaceSettings& space, const Vec3& moving)
      : frame_velocity(moving),
        box(shaken_slab(n), sides(), space, Communicator()),
        flow(box.domain, box.comm) {
    fill(flow, box.domain, [&](const Vec3& x, GlobalIndex) { return vortex(x, start, frame_velocity); });
    RungeKutta3 march(box, {free_stream(stream + frame_velocity, gamma_air), {frame_velocity, {}, {}}});
    const int steps = 2 * n;  // a tenth of a cube a step: errors in time, of third order, do not count
    for (int i = 0; i < steps; ++i) march.advance(flow, duration / steps);
  }
  static BoxSides sides() {
    BoxSides out = open_box();
    out[4] = out[5] = BoundaryKind::symmetry;
    return out;
  }

  /// Error of every variable: root of its mean square over the volume.
  Primitive<Real> error() const {
    Primitive<Real> sum;
    Real volume = 0;
    for (Index cell = 0; cell < box.domain.owned_cells; ++cell) {
      const auto exact = vortex(box.domain.center[cell], start + duration * stream, frame_velocity);
      for (int i = 0; i < 5; ++i) sum[i] += box.domain.volume[cell] * std::pow(flow[cell][i] - exact[i], 2);
      volume += box.domain.volume[cell];
    }
    for (Real& value : sum.v) value = std::sqrt(value / volume);
    return sum;
  }

  Vec3 frame_velocity;
  BoxCase box;
  FlowField<Real> flow;
};

struct VortexScheme {
  FluxKind flux;
  LimiterKind limiter;
  Vec3 frame{};  ///< velocity of everything, grid included
};

SpaceSettings space_of(const VortexScheme& scheme) {
  return {.flux = scheme.flux, .order = 2, .limiter = scheme.limiter, .limiter_threshold = 0.2};
}

class Vortex : public testing::TestWithParam<VortexScheme> {};
INSTANTIATE_TEST_SUITE_P(Schemes, Vortex,
                         testing::Values(VortexScheme{FluxKind::roe, LimiterKind::none},
                                         VortexScheme{FluxKind::roe, LimiterKind::venkatakrishnan},
                                         VortexScheme{FluxKind::van_leer, LimiterKind::venkatakrishnan},
                                         VortexScheme{FluxKind::hllc, LimiterKind::venkatakrishnan},
                                         VortexScheme{FluxKind::roe, LimiterKind::venkatakrishnan, frame}),
                         [](const auto& scheme) {
                           return name_of(scheme.param.flux) +
                                  (scheme.param.limiter == LimiterKind::none ? "_unlimited" : "_limited") +
                                  (norm(scheme.param.frame) > 0 ? "_moving" : "");
                         });

// Between the finest two of three meshes and over all three, for every variable; a scheme of first order
// would show 1.
TEST_P(Vortex, IsSolvedWithSecondOrder) {
  constexpr int cubes[] = {16, 24, 32};
  Primitive<Real> error[3];
  for (int mesh = 0; mesh < 3; ++mesh)
    error[mesh] = VortexRun(cubes[mesh], space_of(GetParam()), GetParam().frame).error();
  const auto order = [&](int coarse, int i) {
    return std::log(error[coarse][i] / error[2][i]) / std::log(Real(cubes[2]) / cubes[coarse]);
  };
  for (int i = 0; i < 5; ++i) {
    EXPECT_GE(order(1, i), 1.9) << "variable " << i;
    EXPECT_GE(order(0, i), 1.9) << "variable " << i;
  }
}

// The field velocity: a grid that moves through the inertial frame with the observer changes nothing but the
// velocities measured. Round-off of a hundred stages.
TEST_P(Vortex, IsTheSameInAMovingFrame) {
  const VortexRun rest(16, space_of(GetParam()), {}), moving(16, space_of(GetParam()), frame);
  for (Index cell = 0; cell < rest.box.domain.owned_cells; ++cell) {
    Primitive<Real> expected = rest.flow[cell];
    for (int i = 0; i < 3; ++i) expected[i + 1] += frame[i];
    for (int i = 0; i < 5; ++i) EXPECT_NEAR(moving.flow[cell][i], expected[i], 1e-10);
  }
}

}  // namespace
}  // namespace alphadot
