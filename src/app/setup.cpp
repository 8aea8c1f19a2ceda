#include "app/setup.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <utility>

#include "core/error.hpp"
#include "core/log.hpp"
#include "core/memory.hpp"
#include "io/case_file.hpp"
#include "io/mesh_reader.hpp"
#include "io/partitioned_mesh.hpp"
#include "io/toml_text.hpp"
#include "space/plausibility.hpp"

namespace alphadot {

Case load_case(const std::string& path, const std::vector<std::string>& overrides, const Communicator& comm) {
  std::string text;
  comm.on_root([&] {
    std::ifstream in(path, std::ios::binary);
    if (!in)
      throw InputError(path, 0, "the case file cannot be opened", "check the path and its permissions");
    text.assign(std::istreambuf_iterator<char>(in), {});
  });
  text = comm.broadcast(text);
  Case out;
  comm.on_all([&] { out = parse_case(text, path, overrides); });
  return out;
}

namespace {

std::vector<BoundaryKind> match_patches(const Case& settings, const std::vector<std::string>& patch_names) {
  std::vector<Problem> problems;
  std::vector<BoundaryKind> kinds;
  for (const auto& name : patch_names) {
    const auto found = settings.boundary.find(name);
    if (found == settings.boundary.end())
      problems.push_back({settings.file, 0,
                          fmt::format("patch \"{}\" of the mesh has no boundary condition", name),
                          fmt::format("add {} = \"wall\", \"symmetry\", \"farfield\", ... to [boundary]",
                                      toml_string(name))});
    else
      kinds.push_back(found->second);
  }
  for (const auto& [name, kind] : settings.boundary)
    if (std::ranges::find(patch_names, name) == patch_names.end())
      problems.push_back({settings.file, 0,
                          fmt::format("[boundary] names \"{}\", which the mesh does not have", name),
                          fmt::format("its patches are {}", fmt::join(patch_names, ", "))});
  if (!problems.empty()) throw InputError(std::move(problems));
  return kinds;
}

/// Reads a mesh that the root holds whole before it is cut.
void distribute_from_root(Setup& setup, const Communicator& comm) {
  const auto& settings = setup.settings;
  MeshOfFile mesh;
  comm.on_root([&] {
    mesh = read_mesh(settings.mesh.file);
    for (const auto& note : mesh.notes) spdlog::info("{}: {}", settings.mesh.file, note);
    mesh.validate();
    std::vector<std::string> names;
    for (const auto& patch : mesh.patches) names.push_back(patch.name);
    match_patches(settings, names);
    setup.mesh.hash = mesh.hash();
  });
  setup.domain = distribute(mesh, comm, settings.mesh.scale);
}

/// Reads a prepared mesh, every rank its own part.
void distribute_in_parallel(Setup& setup, const Communicator& comm) {
  const auto& settings = setup.settings;
  comm.on_root([&] {
    const auto header = read_partitioned_mesh_header(settings.mesh.file);
    match_patches(settings, header.patch_names);
    setup.mesh.hash = header.hash;
  });
  setup.domain = distribute(read_partitioned_mesh(settings.mesh.file, comm), comm, settings.mesh.scale);
}

}  // namespace

Setup load_setup(const Case& settings, const Communicator& comm) {
  Setup out;
  out.settings = settings;
  out.mesh.file = settings.mesh.file;
  const Real before = resident_bytes();
  bool prepared = false;
  comm.on_root([&] { prepared = is_hdf5(settings.mesh.file); });
  if (comm.any(prepared))
    distribute_in_parallel(out, comm);
  else
    distribute_from_root(out, comm);
  const Real peak = std::max(peak_resident_bytes() - before, Real{0});
  out.memory = {comm.sum(static_cast<Real>(out.domain.bytes())), comm.sum(peak), comm.max(peak)};
  out.mesh.hash = comm.broadcast(out.mesh.hash);
  out.mesh.cells = out.domain.global_cells;
  out.mesh.points = out.domain.global_points;
  out.patch_kinds = match_patches(settings, out.domain.patch_names);
  out.configuration = survey(out.domain, out.patch_kinds, settings, comm);
  comm.on_all([&] {
    auto [problems, warnings] = judge(out.configuration, out.domain.patch_names, settings);
    if (!problems.empty()) throw InputError(std::move(problems));
    out.warnings = std::move(warnings);
  });
  return out;
}

}  // namespace alphadot
