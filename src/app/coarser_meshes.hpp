// The same case on coarser meshes, which tell what the mesh does to its derivatives.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "analysis/mesh_convergence.hpp"
#include "app/flow_case.hpp"
#include "app/linear_derivatives.hpp"

namespace alphadot {

/// The cases of the key derivatives.coarser_meshes, in folders "mesh_2" and "mesh_3" below that of the
/// finest, where a restart goes on as well. Collective. Throws InputError with every mesh that cannot be
/// read, has other patches or other walls, or is not coarser than the one before; it names the key.
std::vector<std::unique_ptr<FlowCase>> coarser_cases(const RunOptions& options, const FlowCase& finest);

/// Looks for the same mistakes without setting anything up to compute. Collective.
void check_coarser_meshes(const Setup& finest, const Communicator& comm);

/// Mean spacing of a case's mesh, in its unit: the cube root of the cells' mean volume. Collective.
Real spacing_of(const Setup& setup, const Communicator& comm);

/// Adds the part "mesh" to the uncertainties of the finest mesh.
DerivativeSetOf<MeshConvergence> add_mesh_part(EstimatedDerivatives& finest, const FlowCase& flow,
                                               std::span<const MeshDerivatives> coarser);

}  // namespace alphadot
