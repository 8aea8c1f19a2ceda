// The free stream on the Basic Finner's own mesh, every patch open.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "io/mesh_reader.hpp"
#include "space/residual.hpp"

namespace alphadot {
namespace {

constexpr Real gamma = 1.4;

// Exact property: the fluxes of a uniform state through the faces of a closed cell cancel, whatever uniform
// velocity the grid seems to have. Net fluxes are compared with the size of a face, volume^(2/3); fluxes per
// area are of order 10.
TEST(FinnerFreeStream, IsKeptUnderAnyUniformFieldVelocity) {
  const Communicator comm;
  Mesh mesh;
  comm.on_root([&] { mesh = read_mesh(FINNER_MESH); });
  const Subdomain domain = distribute(mesh, comm);
  const std::vector<BoundaryKind> open(domain.patch_names.size(), BoundaryKind::farfield);
  for (const auto flux : {FluxKind::roe, FluxKind::van_leer, FluxKind::hllc})
    for (const Vec3 grid : {Vec3{}, Vec3{0, 0, -0.1}, Vec3{0.7, -0.3, 0.4}, Vec3{-2, 1, 3}}) {
      SpaceSettings space;
      space.flux = flux;
      const Discretization discretization(domain, open, space, gamma);
      Residual residual(discretization, comm);
      FlowField<Real> flow(domain, comm);
      const auto stream = free_stream(Vec3{2.5, 0, 0.065}, gamma);
      std::fill(flow.values().begin(), flow.values().end(), stream);
      std::vector<Conserved<Real>> values(static_cast<std::size_t>(domain.owned_cells));
      residual.evaluate(flow, {stream, {grid, {}, {}}, {}}, 2, values);
      Real worst = 0;
      for (Index cell = 0; cell < domain.owned_cells; ++cell)
        for (int i = 0; i < 5; ++i)
          worst = std::max(worst, std::abs(values[cell][i]) / std::pow(domain.volume[cell], 2.0 / 3));
      EXPECT_LT(worst, 1e-12) << "flux " << static_cast<int>(flux) << ", grid velocity " << grid.x << " "
                              << grid.y << " " << grid.z;
    }
}

}  // namespace
}  // namespace alphadot
