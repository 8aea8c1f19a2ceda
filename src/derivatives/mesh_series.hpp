// The same case on coarser meshes, which tell what the mesh does to its derivatives.
#pragma once

#include <span>

#include "analysis/mesh_convergence.hpp"
#include "derivatives/flow_case.hpp"

namespace alphadot {

/// Mean spacing of a case's mesh, in its unit: the cube root of the cells' mean volume. Collective.
Real spacing_of(const Setup& setup, const Communicator& comm);

/// How fine a mesh is, and how large the walls of its body, in reference areas.
struct MeshMeasures {
  GlobalIndex cells;
  Real spacing, wall_area;
};
/// Collective.
MeshMeasures measures_of(const Setup& setup, const Communicator& comm);

/// Refuses a mesh that is not coarser than the one before, or not of the same body: throws InputError that
/// names the case file.
void check_is_coarser(const std::string& case_file, const MeshMeasures& found, const MeshMeasures& before);

/// Adds the part "mesh" to the uncertainties of the finest mesh. Collective.
DerivativeSetOf<MeshConvergence> add_mesh_part(EstimatedDerivatives& finest, const FlowCase& flow,
                                               std::span<const MeshDerivatives> coarser);

}  // namespace alphadot
