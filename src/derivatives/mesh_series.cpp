#include "derivatives/mesh_series.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>
#include <vector>

#include "core/error.hpp"

namespace alphadot {

MeshMeasures measures_of(const Setup& setup, const Communicator& comm) {
  return {setup.mesh.cells, spacing_of(setup, comm), setup.configuration.wall_area};
}

void check_is_coarser(const std::string& case_file, const MeshMeasures& found, const MeshMeasures& before) {
  if (found.spacing < least_refinement_ratio * before.spacing)
    throw InputError(
        case_file, 0,
        fmt::format("{} cells are not coarser than the {} of the mesh before", found.cells, before.cells),
        "list meshes that become coarser by 1.3 in each direction");
  constexpr Real like_areas = 1.2;  // facets of curved walls are smaller on a coarser mesh, but not by more
  const auto [least, most] = std::minmax(found.wall_area, before.wall_area);
  if (most > like_areas * least)
    throw InputError(case_file, 0,
                     fmt::format("its walls measure {:.4g} reference areas, those of the mesh before {:.4g}",
                                 found.wall_area, before.wall_area),
                     "list meshes of the same body in the same unit");
}

Real spacing_of(const Setup& setup, const Communicator& comm) {
  const Subdomain& domain = setup.domain;
  const Real volume =
      std::accumulate(domain.volume.begin(), domain.volume.begin() + domain.owned_cells, Real{0});
  return std::cbrt(comm.sum(volume) / static_cast<Real>(domain.global_cells));
}

DerivativeSetOf<MeshConvergence> add_mesh_part(EstimatedDerivatives& finest, const FlowCase& flow,
                                               std::span<const MeshDerivatives> coarser) {
  std::vector<MeshDerivatives> meshes{{spacing_of(flow.setup(), flow.communicator()), finest.derivatives}};
  meshes.insert(meshes.end(), coarser.begin(), coarser.end());
  finest.add("mesh", mesh_uncertainty(meshes, flow.setup().configuration.body_length));
  return mesh_convergence(meshes);
}

}  // namespace alphadot
