#include "app/coarser_meshes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numeric>
#include <string>
#include <utility>

#include "core/error.hpp"

namespace alphadot {

namespace {

Case on_mesh(Case settings, std::size_t number) {
  settings.mesh.file = settings.derivatives.coarser_meshes[number];
  settings.derivatives.coarser_meshes.clear();
  settings.derivatives.limiter_uncertainty = false;
  return settings;
}

RunOptions below(RunOptions options, const FlowCase& finest, std::size_t number) {
  options.folder = fmt::format("{}/mesh_{}", finest.folder(), number + 2);
  options.stop_folder = finest.folder();
  if (options.restart) options.restart = "";
  return options;
}

/// Adds the errors with the key that they come from.
void add(const std::string& file, const InputError& error, std::vector<Problem>& problems) {
  for (auto problem : error.problems()) {
    problem.what = fmt::format("derivatives.coarser_meshes, {}: {}",
                               std::filesystem::path(file).filename().string(), problem.what);
    problems.push_back(std::move(problem));
  }
}

/// How fine a mesh is, and how large the walls of its body, in reference areas.
struct Measures {
  GlobalIndex cells;
  Real spacing, wall_area;
};

Measures measures_of(const Setup& mesh, const Communicator& comm) {
  return {mesh.mesh.cells, spacing_of(mesh, comm), mesh.configuration.wall_area};
}

/// Refuses a mesh that is not coarser than the one before, or not of the same body.
void check_is_coarser(const Setup& mesh, const Measures& found, const Measures& before) {
  if (found.spacing < least_refinement_ratio * before.spacing)
    throw InputError(
        mesh.settings.file, 0,
        fmt::format("{} cells are not coarser than the {} of the mesh before", found.cells, before.cells),
        "list meshes that become coarser by 1.3 in each direction");
  constexpr Real like_areas = 1.2;  // facets of curved walls are smaller on a coarser mesh, but not by more
  const auto [least, most] = std::minmax(found.wall_area, before.wall_area);
  if (most > like_areas * least)
    throw InputError(mesh.settings.file, 0,
                     fmt::format("its walls measure {:.4g} reference areas, those of the mesh before {:.4g}",
                                 found.wall_area, before.wall_area),
                     "list meshes of the same body in the same unit");
}

}  // namespace

std::vector<std::unique_ptr<FlowCase>> coarser_cases(const RunOptions& options, const FlowCase& finest) {
  std::vector<std::unique_ptr<FlowCase>> out;
  std::vector<Problem> problems;
  const auto& comm = finest.communicator();
  auto finer = measures_of(finest.setup(), comm);
  const auto& files = finest.settings().derivatives.coarser_meshes;
  for (std::size_t i = 0; i < files.size(); ++i) try {
      out.push_back(std::make_unique<FlowCase>(on_mesh(finest.settings(), i), below(options, finest, i),
                                               "derivatives", comm));
      const auto found = measures_of(out.back()->setup(), comm);
      check_is_coarser(finest.setup(), found, std::exchange(finer, found));
    } catch (const InputError& error) {
      add(files[i], error, problems);
    }
  if (!problems.empty()) throw InputError(std::move(problems));
  return out;
}

void check_coarser_meshes(const Setup& finest, const Communicator& comm) {
  std::vector<Problem> problems;
  auto finer = measures_of(finest, comm);
  for (const auto& file : finest.settings.derivatives.coarser_meshes) try {
      Case settings = finest.settings;
      settings.mesh.file = file;
      const auto found = measures_of(load_setup(settings, comm), comm);
      check_is_coarser(finest, found, std::exchange(finer, found));
    } catch (const InputError& error) {
      add(file, error, problems);
    }
  if (!problems.empty()) throw InputError(std::move(problems));
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
