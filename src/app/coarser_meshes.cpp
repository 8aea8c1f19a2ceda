#include "app/coarser_meshes.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <string>
#include <utility>

#include "core/error.hpp"
#include "derivatives/mesh_series.hpp"

namespace alphadot {

namespace {

Case on_mesh(Case settings, std::size_t number) {
  settings.mesh.file = settings.derivatives.coarser_meshes[number];
  settings.derivatives.coarser_meshes.clear();
  settings.derivatives.limiter_uncertainty = false;
  return settings;
}

RunOptions below(RunOptions options, const CaseRun& finest, std::size_t number) {
  options.folder = fmt::format("{}/mesh_{}", finest.record().folder(), number + 2);
  options.stop_folder = finest.record().folder();
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

}  // namespace

std::vector<std::unique_ptr<CaseRun>> coarser_runs(const RunOptions& options, const CaseRun& finest) {
  std::vector<std::unique_ptr<CaseRun>> out;
  std::vector<Problem> problems;
  const auto& comm = finest.communicator();
  auto finer = measures_of(finest.flow().setup(), comm);
  const auto& files = finest.settings().derivatives.coarser_meshes;
  for (std::size_t i = 0; i < files.size(); ++i) try {
      out.push_back(std::make_unique<CaseRun>(on_mesh(finest.settings(), i), below(options, finest, i),
                                              "derivatives", comm));
      const auto found = measures_of(out.back()->flow().setup(), comm);
      check_is_coarser(finest.settings().file, found, std::exchange(finer, found));
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
      check_is_coarser(finest.settings.file, found, std::exchange(finer, found));
    } catch (const InputError& error) {
      add(file, error, problems);
    }
  if (!problems.empty()) throw InputError(std::move(problems));
}

}  // namespace alphadot
