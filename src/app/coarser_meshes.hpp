// Runs of the same case on coarser meshes.
#pragma once

#include <memory>
#include <vector>

#include "app/case_run.hpp"
#include "derivatives/mesh_series.hpp"

namespace alphadot {

/// Those of the key derivatives.coarser_meshes, in folders "mesh_2" and "mesh_3" below that of the finest,
/// where a restart goes on as well. Collective. Throws InputError with every mesh that cannot be read, has
/// other patches or other walls, or is not coarser than the one before; it names the key.
std::vector<std::unique_ptr<CaseRun>> coarser_runs(const RunOptions& options, const CaseRun& finest);

/// Looks for the same mistakes without setting anything up to compute. Collective.
void check_coarser_meshes(const Setup& finest, const Communicator& comm);

}  // namespace alphadot
