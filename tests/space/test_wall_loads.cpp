// Loads on walls. Expectations: integrals of a given pressure over plane patches.
#include <gtest/gtest.h>

#include "space/forces.hpp"
#include "support/box_case.hpp"

namespace alphadot {
namespace {

using namespace testing_support;

const Vec3 center{0.3, -0.1, 0.4};  // of moments
const Vec3 slope{0.2, -0.15, 0.1};  // of the linear pressure

Real linear_pressure(const Vec3& x) {
  return 2 + dot(slope, x);
}

/// Loads of all ranks on a box of the given mesh, gas at rest with the given pressure.
template <class Pressure>
std::vector<Load> loads(const BoxSettings& settings, const BoxSides& sides, int order, Pressure&& pressure) {
  const Communicator comm;
  const BoxCase box(box_mesh(settings), sides, {.order = order, .limiter = LimiterKind::none}, comm);
  FlowField<Real> flow(box.domain, comm);
  fill(flow, box.domain, [&](const Vec3& x, GlobalIndex) {
    return Primitive<Real>{{1, 0, 0, 0, pressure(x)}};
  });
  Residual residual(box.discretization, comm);
  std::vector<Conserved<Real>> values(box.cells());
  residual.evaluate(flow, {free_stream(Vec3{}, gamma_air), {}}, order, values);
  auto out = wall_loads(box.discretization, residual, center);
  for (auto& load : out)
    for (Real* entry :
         {&load.force.x, &load.force.y, &load.force.z, &load.moment.x, &load.moment.y, &load.moment.z})
      *entry = comm.sum(*entry);
  return out;
}

void expect_near(const Vec3& found, const Vec3& expected, Real tolerance) {
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(found[i], expected[i], tolerance);
}

BoxSides walls_below_and_above() {
  BoxSides sides = open_box();
  sides[4] = sides[5] = BoundaryKind::wall;
  return sides;
}

const BoxSettings box{.cells = {4, 3, 3}, .lower = {-1, 0, 2}, .upper = {1, 1.2, 3}, .perturbation = 0.12};

// Constant pressure over a patch: force (p - p_inf) A n at the patch's middle.
TEST(WallLoads, ActInTheMiddleOfAPatchUnderConstantPressure) {
  for (const int order : {1, 2}) {
    const auto found = loads(box, walls_below_and_above(), order, [](const Vec3&) { return 2.0; });
    const Vec3 up{0, 0, (2 - 1 / gamma_air) * 2 * 1.2};
    expect_near(found[4].force, -up, 1e-13);
    expect_near(found[5].force, up, 1e-13);
    expect_near(found[4].moment, cross(Vec3{0, 0.6, 2} - center, -up), 1e-13);
    expect_near(found[5].moment, cross(Vec3{0, 0.6, 3} - center, up), 1e-13);
  }
}

TEST(WallLoads, VanishAtTheFreeStreamPressure) {
  for (const Load& load : loads(box, channel(), 2, [](const Vec3&) { return 1 / gamma_air; })) {
    expect_near(load.force, {}, 1e-15);
    expect_near(load.moment, {}, 1e-15);
  }
}

// Second order carries a linear pressure to the wall without error; its integral is its value in the middle.
TEST(WallLoads, AreExactForALinearPressure) {
  const auto found = loads(box, walls_below_and_above(), 2, linear_pressure);
  const auto force = [](const Vec3& middle) { return (linear_pressure(middle) - 1 / gamma_air) * 2 * 1.2; };
  expect_near(found[4].force, {0, 0, -force({0, 0.6, 2})}, 1e-13);
  expect_near(found[5].force, {0, 0, force({0, 0.6, 3})}, 1e-13);
}

// Moments of a linear pressure p = p_m + s.(x - x_m) on a rectangle a x b: those of the mean, and from the
// slope (x cross n) s_x a^2 A / 12 and the like. One point a triangle errs by the square of the spacing: on
// plane patches of equal triangles half as large, by a quarter.
TEST(WallLoads, HaveMomentsOfSecondOrder) {
  const Real area = 2 * 1.2;
  const Real lift = (linear_pressure({0, 0.6, 3}) - 1 / gamma_air) * area;
  const Vec3 exact = cross(Vec3{0, 0.6, 3} - center, Vec3{0, 0, lift}) +
                     Vec3{slope.y * 1.2 * 1.2 * area / 12, -slope.x * 2 * 2 * area / 12, 0};
  Vec3 error[2];
  for (const int level : {0, 1}) {
    BoxSettings mesh = box;
    for (int& n : mesh.cells) n *= 1 + level;
    error[level] = loads(mesh, walls_below_and_above(), 2, linear_pressure)[5].moment - exact;
  }
  for (int axis = 0; axis < 2; ++axis) EXPECT_NEAR(error[0][axis] / error[1][axis], 4, 0.01);
  EXPECT_NEAR(error[1].z, 0, 1e-13);
}

// Stings, jets, symmetry planes and the far field carry no load.
TEST(WallLoads, CountWallsAlone) {
  const BoxSides sides{BoundaryKind::farfield, BoundaryKind::jet,  BoundaryKind::symmetry,
                       BoundaryKind::symmetry, BoundaryKind::wall, BoundaryKind::sting};
  const auto found = loads(box, sides, 2, [](const Vec3&) { return 2.0; });
  for (const int patch : {0, 1, 2, 3, 5}) EXPECT_EQ(norm(found[patch].force) + norm(found[patch].moment), 0);
  EXPECT_GT(norm(found[4].force), 1);
}

}  // namespace
}  // namespace alphadot
