#include "app/coarser_meshes.hpp"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <numeric>
#include <string>
#include <utility>

#include "core/error.hpp"
#include "io/toml_text.hpp"

namespace alphadot {

namespace {

CaseArguments on_mesh(CaseArguments arguments, const FlowCase& finest, std::size_t number) {
  arguments.folder = fmt::format("{}/mesh_{}", finest.folder(), number + 2);
  arguments.stop_folder = finest.folder();
  if (arguments.restart) arguments.restart = "";
  for (const auto& change :
       {"mesh.file=" + toml_string(finest.settings().derivatives.coarser_meshes[number]),
        std::string("derivatives.coarser_meshes=[]"), std::string("derivatives.limiter_uncertainty=false")})
    arguments.overrides.push_back(change);
  return arguments;
}

/// The same errors with the key that they come from.
InputError of_mesh(const std::string& file, const InputError& error) {
  auto problems = error.problems();
  for (auto& problem : problems)
    problem.what = fmt::format("derivatives.coarser_meshes, {}: {}",
                               std::filesystem::path(file).filename().string(), problem.what);
  return InputError(std::move(problems));
}

}  // namespace

std::vector<std::unique_ptr<FlowCase>> coarser_cases(const CaseArguments& arguments, const FlowCase& finest) {
  std::vector<std::unique_ptr<FlowCase>> out;
  const auto& files = finest.settings().derivatives.coarser_meshes;
  for (std::size_t i = 0; i < files.size(); ++i) {
    const auto& finer = out.empty() ? finest : *out.back();
    try {
      auto coarser =
          std::make_unique<FlowCase>(on_mesh(arguments, finest, i), "derivatives", finest.communicator());
      if (spacing_of(*coarser) < least_refinement_ratio * spacing_of(finer))
        throw InputError(finest.settings().file, 0,
                         fmt::format("{} cells are not coarser than the {} of the mesh before",
                                     coarser->setup().mesh.cells, finer.setup().mesh.cells),
                         "list meshes that become coarser by 1.3 in each direction");
      out.push_back(std::move(coarser));
    } catch (const InputError& error) {
      throw of_mesh(files[i], error);
    }
  }
  return out;
}

Real spacing_of(const FlowCase& flow) {
  const Subdomain& domain = flow.setup().domain;
  const Real volume =
      std::accumulate(domain.volume.begin(), domain.volume.begin() + domain.owned_cells, Real{0});
  return std::cbrt(flow.communicator().sum(volume) / static_cast<Real>(domain.global_cells));
}

DerivativeSetOf<MeshConvergence> add_mesh_part(EstimatedDerivatives& finest, const FlowCase& flow,
                                               std::span<const MeshDerivatives> coarser) {
  std::vector<MeshDerivatives> meshes{{spacing_of(flow), finest.derivatives}};
  meshes.insert(meshes.end(), coarser.begin(), coarser.end());
  finest.add("mesh", mesh_uncertainty(meshes, flow.setup().configuration.body_length));
  return mesh_convergence(meshes);
}

}  // namespace alphadot
