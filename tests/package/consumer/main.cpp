// A program of somebody who calls the library: the steady flow over the cube of the tests, and its normal
// force. usage: consumer MESH
#include <cmath>
#include <cstdio>
#include <memory>

#include "analysis/coefficients.hpp"
#include "core/communicator.hpp"
#include "io/mesh_reader.hpp"
#include "linear/block_lu_sgs.hpp"
#include "march/steady.hpp"
#include "partition/subdomain.hpp"
#include "space/conditions.hpp"

using namespace alphadot;

int main(int argc, char** argv) {
  const MpiSession mpi(argc, argv);
  const Communicator world;
  const Real mach = 2, alpha = 1 * radians_per_degree, gamma = 1.4;

  Mesh mesh;
  if (world.is_root()) mesh = read_mesh(argv[1]);
  const Subdomain domain = distribute(mesh, world);
  std::vector<BoundaryKind> kinds;
  for (const auto& name : domain.patch_names)
    kinds.push_back(name == "wall"    ? BoundaryKind::wall
                    : name == "sides" ? BoundaryKind::symmetry
                                      : BoundaryKind::farfield);
  const Discretization discretization(domain, kinds, SpaceSettings{}, gamma);
  ImplicitIteration iteration(discretization, world, std::make_unique<BlockLuSgs>(discretization, world, 3),
                              Vec3{});
  const auto conditions = steady_conditions(wind_velocity(mach, alpha, 0), {}, gamma);
  iteration.set_uniform(conditions.free_stream);
  const auto result =
      march_to_steady(iteration, conditions, SteadySettings{}, 2, [](const SteadyProgress&) { return true; });
  const Real scale = 1 / (0.5 * mach * mach);
  const auto loads = coefficients_of(scale * result.report.total.force, scale * result.report.total.moment);
  if (world.is_root()) std::printf("%s CN %.6f\n", to_string(result.status).c_str(), loads.CN);
  return exit_code(result.status);
}
