// What leaves one cell enters another: residuals add up to the fluxes through the boundary and the sources.
#include <gtest/gtest.h>

#include <tuple>

#include "euler/boundary.hpp"
#include "space/residual.hpp"
#include "support/box_case.hpp"

namespace alphadot {
namespace {

using namespace testing_support;

class Conservation : public testing::TestWithParam<std::tuple<FluxKind, int>> {};
INSTANTIATE_TEST_SUITE_P(Schemes, Conservation,
                         testing::Combine(testing::ValuesIn(all_fluxes), testing::Values(1, 2)),
                         [](const auto& scheme) {
                           return name_of(std::get<0>(scheme.param)) +
                                  std::to_string(std::get<1>(scheme.param));
                         });

TEST_P(Conservation, AddsUpToBoundaryFluxesAndSources) {
  const auto [kind, order] = GetParam();
  const Communicator comm;
  const BoxCase box(small_box(), channel(), {.flux = kind, .order = order}, comm);
  const Conditions<Real> conditions{free_stream(Vec3{1.5, 0.1, -0.2}, gamma_air), tumbling_grid()};
  FlowField<Real> flow(box.domain, comm);
  fill(flow, box.domain, rough_state);
  Residual residual(box.discretization, comm);
  std::vector<Conserved<Real>> values(box.cells());
  residual.evaluate(flow, conditions, order, values);

  Conserved<Real> outflow{};
  for (std::size_t i = 0; i < box.domain.boundary_faces.size(); ++i) {
    const auto& face = box.domain.boundary_faces[i];
    const Vec3 at = box.domain.boundary_center[i];
    const Real area = norm(box.domain.boundary_normal[i]);
    const Vec3 normal = (1 / area) * box.domain.boundary_normal[i];
    const Real speed = dot(conditions.grid.at(at), normal);
    const auto inside = inner_state(box.domain, flow, residual.reconstruction(), i, order).inside;
    const bool open = box.discretization.kind_of(face) == BoundaryKind::farfield;
    outflow += area * (open ? far_field_flux(inside, conditions.free_stream, normal, speed, gamma_air)
                            : wall_flux(residual.boundary_pressures()[i], normal, speed));
  }
  for (Index cell = 0; cell < box.domain.owned_cells; ++cell) {
    const Real mass = box.domain.volume[cell] * flow[cell][0];
    const Vec3 source = mass * cross(conditions.grid.rotation, velocity(flow[cell]));
    outflow += Conserved<Real>{{0, source.x, source.y, source.z, 0}};
  }
  comm.sum(std::span<Real>(outflow.v));
  const auto sum = total(box.domain, comm, values);
  for (int i = 0; i < 5; ++i) EXPECT_NEAR(sum[i], outflow[i], 1e-12);  // a thousand fluxes of 0.1
}

}  // namespace
}  // namespace alphadot
