// The sensitivity of residual and loads to the points of a mesh, against central differences of whole
// residuals on meshes whose points have moved.
#include "linear/shape_transpose.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "support/box_case.hpp"

namespace alphadot {
namespace {

using namespace testing_support;

// Kinks of the limiter ask for small steps; round-off 1e-16 / step = 1e-10 of sums of some hundred.
constexpr Real step = 1e-6, tolerance = 1e-7;
const Vec3 center{0.3, -0.1, 0.4};
constexpr BoxSides all_sides{BoundaryKind::farfield, BoundaryKind::wall, BoundaryKind::wall,
                             BoundaryKind::symmetry, BoundaryKind::jet,  BoundaryKind::sting};

Real scatter(GlobalIndex id, int i) {
  return std::sin(7.0 * static_cast<Real>(id) + 3 * i);
}

/// Every point goes its own way, those of the boundary too.
Vec3 displacement(GlobalIndex point) {
  return {scatter(point, 1), scatter(point, 5), scatter(point, 9)};
}

Mesh moved(Mesh mesh, Real share) {
  for (std::size_t point = 0; point < mesh.points.size(); ++point)
    mesh.points[point] += share * displacement(static_cast<GlobalIndex>(point));
  return mesh;
}

/// y . R + weights . loads of one flow, given by cell id, on a mesh.
struct Functional {
  Functional(const SpaceSettings& space, Real share)
      : box(moved(small_box(), share), all_sides, space, Communicator(), Dissipative::some),
        flow(box.domain, box.comm),
        residual(box.discretization, box.comm),
        values(box.cells()),
        adjoint(box.cells()) {
    const Mesh unmoved = small_box();
    for (Index cell = 0; cell < box.domain.owned_cells; ++cell) {
      const GlobalIndex id = box.domain.cell_ids[cell];
      Vec3 x;
      for (const GlobalIndex point : unmoved.cells[static_cast<std::size_t>(id)])
        x += 0.25 * unmoved.points[static_cast<std::size_t>(point)];
      flow[cell] = rough_state(x, id);
      for (int i = 0; i < 5; ++i) adjoint[cell][i] = scatter(id, i);
    }
    for (int patch = 0; patch < 6; ++patch) weights.push_back({displacement(patch), displacement(patch + 6)});
    residual.evaluate(flow, conditions, space.order, values);
  }
  Real value() const {
    const auto loads = wall_loads(box.discretization, residual, center);
    Real sum = 0;
    for (std::size_t cell = 0; cell < values.size(); ++cell)
      for (int i = 0; i < 5; ++i) sum += adjoint[cell][i] * values[cell][i];
    for (std::size_t patch = 0; patch < weights.size(); ++patch)
      sum += dot(weights[patch].force, loads[patch].force) + dot(weights[patch].moment, loads[patch].moment);
    return box.comm.sum(sum);
  }
  /// Along the displacement of all points.
  Real derivative() {
    const Linearisation linearisation(box.discretization, box.comm, flow, residual.reconstruction(),
                                      conditions);
    const auto by_points = shape_transpose(linearisation, flow, adjoint, weights, center);
    Real sum = 0;
    for (std::size_t point = 0; point < by_points.size(); ++point)
      sum += dot(by_points[point], displacement(box.domain.point_ids[point]));
    return box.comm.sum(sum);
  }

  const Vec3 wind{1.5, 0.1, -0.2};
  const Conditions<Real> conditions{free_stream(wind, gamma_air), tumbling_grid(), wind};
  BoxCase box;
  FlowField<Real> flow;
  Residual residual;
  std::vector<Conserved<Real>> values, adjoint;
  std::vector<Load> weights;
};

class ShapeTransposeTest
    : public testing::TestWithParam<std::tuple<FluxKind, LimiterKind, GradientKind, int>> {};
INSTANTIATE_TEST_SUITE_P(Schemes, ShapeTransposeTest,
                         testing::Combine(testing::ValuesIn(all_fluxes),
                                          testing::Values(LimiterKind::none, LimiterKind::venkatakrishnan,
                                                          LimiterKind::mlp_u2, LimiterKind::barth_jespersen),
                                          testing::Values(GradientKind::least_squares,
                                                          GradientKind::green_gauss),
                                          testing::Values(1, 2)));

TEST_P(ShapeTransposeTest, AgreesWithCentralDifferencesOfMovedMeshes) {
  const auto [flux, limiter, gradient, order] = GetParam();
  const SpaceSettings space{.flux = flux, .order = order, .gradient = gradient, .limiter = limiter};
  const Real difference = (Functional(space, step).value() - Functional(space, -step).value()) / (2 * step);
  EXPECT_NEAR(Functional(space, 0).derivative(), difference, tolerance * std::abs(difference));
}

}  // namespace
}  // namespace alphadot
