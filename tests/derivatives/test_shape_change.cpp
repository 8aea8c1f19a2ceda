// Walls that turn about a hinge: how the mesh follows, and what that does to steady flows. Expected are a
// rigid turn, loads of steady flows on meshes that have been displaced, and the exact transpose of the
// derivative by the points.
#include "derivatives/shape_change.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "derivatives/adjoint.hpp"
#include "derivatives/flow_case.hpp"
#include "derivatives/sensitivity.hpp"
#include "march/deflection.hpp"
#include "support/ramp.hpp"
#include "support/steady_flow.hpp"

namespace alphadot {
namespace {

using namespace testing_support;

constexpr int cubes = 8;
/// Across the ramp, a little above its foot.
const Hinge hinge{{0.2, 0, 0.1}, {0, 1, 0}};

/// Values of the points of all ranks by global id, on every rank.
std::vector<Vec3> by_point_id(const Subdomain& domain, const Communicator& comm,
                              std::span<const Vec3> of_points) {
  std::vector<Real> all(4 * static_cast<std::size_t>(domain.global_points), 0);
  for (std::size_t point = 0; point < of_points.size(); ++point) {
    Real* at = &all[4 * static_cast<std::size_t>(domain.point_ids[point])];
    for (int axis = 0; axis < 3; ++axis) at[axis] += of_points[point][axis];
    at[3] += 1;
  }
  comm.sum(all);
  std::vector<Vec3> out;
  for (auto at = all.begin(); at != all.end(); at += 4) out.push_back(1 / at[3] * Vec3{at[0], at[1], at[2]});
  return out;
}

class ShapeChangeTest : public testing::Test {
 protected:
  const Communicator comm;
  const SpaceSettings space{.freeze_orders = 0};
  const BoxCase box{ramp_mesh(cubes), ramp_sides(), space, comm};
  const Conditions<Real> conditions = steady_conditions({ramp_mach, 0, 0}, {}, gamma_air);
  const std::vector<std::string> ramp{box.domain.patch_names[4]};
  const Deflection turned = deflection(box.discretization, ramp, hinge, comm);
  const DerivativeSettings settings{.orders = 9, .max_iterations = 600};

  std::size_t points() const { return box.domain.points.size(); }
};

TEST_F(ShapeChangeTest, WallsTurnAndOthersAreSlidAlong) {
  ASSERT_EQ(turned.displacement.size(), points());
  const Real ceiling = 1, fore = -0.25, aft = 1;
  int on_the_ramp = 0;
  for (std::size_t point = 0; point < points(); ++point) {
    const Vec3 x = box.domain.points[point], u = turned.displacement[point];
    const Vec3 rigid = cross(hinge.axis, x - hinge.point);
    const Real height = std::max(Real{0}, x.x) * std::tan(ramp_angle);
    const bool is_at_end = x.x == fore || x.x == aft;
    const bool is_on_ramp = std::abs(x.z - height) < 1e-12;
    if (is_on_ramp) ++on_the_ramp;
    const auto expect = [&](bool of_these, Real value, Real expected) {
      if (of_these) {
        EXPECT_NEAR(value, expected, 1e-14);
      }
    };
    expect(is_on_ramp, u.z, rigid.z);
    expect(is_on_ramp && !is_at_end, u.x, rigid.x);
    expect(true, u.y, 0);
    expect(is_at_end, u.x, 0);
    expect(x.z == ceiling, u.z, 0);
  }
  EXPECT_GT(comm.sum(static_cast<Real>(on_the_ramp)), 20);
  EXPECT_LT(turned.lost_at_symmetry, 1e-14);
  EXPECT_NEAR(turned.lost_at_walls, 0.1 / std::hypot(0.8, std::tan(ramp_angle) - 0.1), 1e-3);
}

// Where the walls lie in the plane of symmetry, turning them out of it is noticed.
TEST_F(ShapeChangeTest, NoticesWallsThatLeaveAPlaneOfSymmetry) {
  EXPECT_GT(deflection(box.discretization, ramp, {{0, 0, 0}, {1, 0, 0}}, comm).lost_at_symmetry, 0.01);
}

// A large angle is many small ones: a rigid turn for the walls, but at the ends, where they slide.
TEST_F(ShapeChangeTest, DeflectsByFiniteAngles) {
  Subdomain domain = box.domain;
  Discretization discretization(domain, box.discretization.patch_kinds(), space, gamma_air);
  constexpr Real angle = 0.05;
  ASSERT_TRUE(deflect(domain, discretization, ramp, hinge, angle, comm));
  for (std::size_t point = 0; point < points(); ++point) {
    const Vec3 x = box.domain.points[point], arm = x - hinge.point;
    const Real height = std::max(Real{0}, x.x) * std::tan(ramp_angle);
    if (std::abs(x.z - height) > 1e-12 || x.x == -0.25 || x.x == 1) continue;
    EXPECT_NEAR(domain.points[point].x, hinge.point.x + std::cos(angle) * arm.x + std::sin(angle) * arm.z,
                1e-6);
    EXPECT_NEAR(domain.points[point].z, hinge.point.z + std::cos(angle) * arm.z - std::sin(angle) * arm.x,
                1e-6);
  }
  EXPECT_FALSE(deflect(domain, discretization, ramp, hinge, -1.5, comm));  // it closes the channel
}

class ShapeResponseTest : public ShapeChangeTest {
 protected:
  SteadyFlow steady{box, conditions, 12};
  const HeldFlowChange change =
      change_by_displacement(steady.iteration, conditions, turned.displacement, false);

  Sensitivity response() {
    SensitivityProblem problem{"turn", {}};
    problem.defect = change.residual;
    problem.own_loads = change.loads;
    return SensitivitySolver(steady.iteration, conditions, settings).solve({problem}).front();
  }
};

TEST_F(ShapeResponseTest, IsTheDifferenceOfSteadyFlowsOnDisplacedMeshes) {
  constexpr Real step = 1e-6;
  const auto displacement = by_point_id(box.domain, comm, turned.displacement);
  const auto load_at = [&](Real share) {
    Mesh mesh = ramp_mesh(cubes);
    for (std::size_t point = 0; point < mesh.points.size(); ++point)
      mesh.points[point] += share * displacement[point];
    const BoxCase moved(mesh, ramp_sides(), space, comm);
    return SteadyFlow(moved, conditions, 12).result.report.total;
  };
  const Load expected = 0.5 / step * (load_at(step) - load_at(-step)), found = response().total;
  for (const int axis : {0, 2})
    EXPECT_NEAR(found.force[axis], expected.force[axis], 1e-5 * std::abs(expected.force[axis]));
  EXPECT_NEAR(found.moment.y, expected.moment.y, 1e-5 * std::abs(expected.moment.y));
  EXPECT_GT(std::abs(expected.moment.y), 0.01);
}

// Of points that move alike, as of a body that the stream passes faster.
TEST_F(ShapeResponseTest, OfAVelocityOfAllPointsIsThatOfTheGrid) {
  const Vec3 velocity{0.3, 0, -0.2};
  const std::vector<Vec3> alike(points(), velocity);
  const auto moving = change_by_velocity(steady.iteration, conditions, alike);
  SensitivityProblem problem{"points", {}};
  problem.defect = moving.residual;
  problem.own_loads = moving.loads;
  SensitivitySolver solver(steady.iteration, conditions, settings);
  const auto found = solver.solve({problem}).front(),
             expected = solver.solve({{"grid", {{}, velocity, {}}}}).front();
  for (const int axis : {0, 2})
    EXPECT_NEAR(found.total.force[axis], expected.total.force[axis], 1e-6 * norm(expected.total.force));
  EXPECT_GT(norm(expected.total.force), 0.01);
}

// A uniform stream does not feel what points inside it do.
TEST_F(ShapeChangeTest, AUniformStreamFeelsNoMotionOfThePoints) {
  SteadyFlow still(box, conditions, 0.1);
  still.iteration.set_uniform(conditions.free_stream);
  std::vector<Vec3> any(points());
  for (std::size_t point = 0; point < points(); ++point) {
    const auto id = static_cast<Real>(box.domain.point_ids[point]);
    any[point] = {std::sin(7 * id), std::sin(5 * id + 1), std::sin(3 * id + 2)};
  }
  const auto moving = change_by_velocity(still.iteration, conditions, any);
  std::vector<bool> is_at_wall(box.cells());
  for (const auto& face : box.domain.boundary_faces)
    if (is_impermeable(box.discretization.kind_of(face)))
      is_at_wall[static_cast<std::size_t>(face.cell)] = true;
  Real largest = 0, at_walls = 0;
  for (std::size_t cell = 0; cell < box.cells(); ++cell)
    for (int i = 0; i < 5; ++i)
      (is_at_wall[cell] ? at_walls : largest) =
          std::max(is_at_wall[cell] ? at_walls : largest, std::abs(moving.residual[cell][i]));
  EXPECT_LT(comm.max(largest), 1e-9);
  EXPECT_GT(comm.max(at_walls), 1e-4);
}

// A few points that move change a few cells: all that they change, and on every rank. The expected number is
// the definition, whole residuals on whole displaced meshes.
TEST_F(ShapeResponseTest, IsThatOfTheWholeMesh) {
  std::vector<Vec3> some(points());
  const Vec3 middle{0.6, 0.0625, 0.2};
  for (std::size_t point = 0; point < points(); ++point)
    if (norm(box.domain.points[point] - middle) < 0.2) some[point] = {0.2, 0.1, -0.3};
  const auto found = change_by_displacement(steady.iteration, conditions, some, false);
  constexpr Real step = 1e-5;
  std::vector<std::vector<Conserved<Real>>> sides;
  std::vector<std::vector<Load>> loads;
  for (const Real share : {-step, step}) {
    Subdomain domain = box.domain;
    for (std::size_t point = 0; point < points(); ++point) domain.points[point] += share * some[point];
    domain.update_metrics();
    const Discretization moved(domain, box.discretization.patch_kinds(), space, gamma_air);
    Residual residual(moved, comm);
    residual.evaluate(steady.iteration.flow(), conditions, 2, sides.emplace_back(box.cells()));
    loads.push_back(face_loads(moved, excess_pressures(moved, residual), steady.iteration.moment_center()));
  }
  GlobalIndex changed = 0;
  for (std::size_t cell = 0; cell < box.cells(); ++cell) {
    changed += norm(Vec3{found.residual[cell][0], found.residual[cell][1], found.residual[cell][4]}) > 0;
    for (int i = 0; i < 5; ++i)
      EXPECT_NEAR(found.residual[cell][i], 0.5 / step * (sides[1][cell][i] - sides[0][cell][i]), 1e-9);
  }
  for (std::size_t face = 0; face < loads[0].size(); ++face) {
    const Load expected = 0.5 / step * (loads[1][face] - loads[0][face]);
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_NEAR(found.of_faces[face].force[axis], expected.force[axis], 1e-9);
      EXPECT_NEAR(found.of_faces[face].moment[axis], expected.moment[axis], 1e-9);
    }
  }
  EXPECT_GT(comm.sum(changed), 20);
  EXPECT_LT(comm.sum(changed), box.domain.global_cells / 2);
}

TEST_F(ShapeResponseTest, IsWhatAdjointsSay) {
  const Load weight{{0.3, 0, 1}, {0, -0.7, 0}};
  const std::vector<Load> weights(box.domain.patch_names.size(), weight);
  AdjointSolver solver(steady.iteration, conditions, settings);
  const auto adjoint = solver.solve({{"load", weights}}).front();
  const auto by_points = solver.by_points(adjoint, weights);
  Real sum = 0;
  for (std::size_t point = 0; point < points(); ++point)
    sum += dot(by_points[point], turned.displacement[point]);
  const Load total = response().total;
  const Real found = dot(weight.force, total.force) + dot(weight.moment, total.moment);
  EXPECT_NEAR(found, comm.sum(sum), 1e-6 * std::abs(found));
}

// Blunt edges that mesh.aft_jets has parted from a fin turn with it.
TEST(Controls, TurnWithTheirAftFaces) {
  const ControlSettings fin{"fin", {"fin", "tip"}, {}, {0, 1, 0}};
  MeshSettings mesh;
  EXPECT_EQ(turning_patches(fin, mesh), fin.patches);
  mesh.aft_jets = {"body", "fin"};
  EXPECT_EQ(turning_patches(fin, mesh), (std::vector<std::string>{"fin", "tip", "fin_aft"}));
}

}  // namespace
}  // namespace alphadot
