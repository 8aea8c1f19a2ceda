#include "derivatives/setup.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <utility>

#include "core/error.hpp"
#include "core/log.hpp"
#include "core/memory.hpp"
#include "derivatives/time_plan.hpp"
#include "io/files.hpp"
#include "io/history.hpp"
#include "io/mesh_reader.hpp"
#include "io/partitioned_mesh.hpp"
#include "io/seal.hpp"
#include "io/toml_text.hpp"
#include "partition/aft_faces.hpp"
#include "partition/thin_walls.hpp"
#include "space/plausibility.hpp"

namespace alphadot {

namespace {

constexpr std::uintmax_t largest_table = 16 << 20;  ///< bytes

/// Adds what is wrong between the patches of a mesh and [boundary].
void add_patch_problems(const Case& settings, const std::vector<std::string>& patch_names,
                        std::vector<Problem>& problems) {
  for (const auto& name : patch_names)
    if (!settings.boundary.contains(name))
      problems.push_back({settings.file, 0,
                          fmt::format("patch \"{}\" of the mesh has no boundary condition", name),
                          fmt::format("add {} = \"wall\", \"symmetry\", \"farfield\", ... to [boundary]",
                                      toml_string(name))});
  for (const auto& [name, kind] : settings.boundary) {
    if (kind == BoundaryKind::wall && is_reserved_component(name))
      problems.push_back(
          {settings.file, 0,
           fmt::format("a wall cannot be called \"{}\": the history of loads has other columns "
                       "of that name",
                       name),
           "rename the patch in the mesh"});
    if (std::ranges::find(patch_names, name) != patch_names.end()) continue;
    const auto line = settings.boundary_lines.find(name);
    problems.push_back({settings.file, line == settings.boundary_lines.end() ? 0 : line->second,
                        fmt::format("[boundary] names \"{}\", which the mesh does not have", name),
                        fmt::format("its patches are {}", fmt::join(patch_names, ", "))});
  }
}

/// Adds what is wrong with mesh.aft_jets.
void add_aft_problems(const Case& settings, const std::vector<std::string>& patch_names,
                      std::vector<Problem>& problems) {
  for (const auto& name : settings.mesh.aft_jets) {
    const auto found = settings.boundary.find(name);
    if (found == settings.boundary.end() || found->second != BoundaryKind::wall)
      problems.push_back({settings.file, 0, fmt::format("mesh.aft_jets names \"{}\", which is no wall", name),
                          "name patches that [boundary] makes walls"});
    if (std::ranges::count(settings.mesh.aft_jets, name) > 1)
      problems.push_back(
          {settings.file, 0, fmt::format("mesh.aft_jets names \"{}\" twice", name), "name each once"});
    if (std::ranges::find(patch_names, aft_name(name)) != patch_names.end())
      problems.push_back({settings.file, 0,
                          fmt::format("mesh.aft_jets would make a second patch \"{}\"", aft_name(name)),
                          "rename that of the mesh"});
  }
}

/// Parts the walls of mesh.aft_jets.
void make_aft_jets(Setup& setup, const Communicator& comm) {
  const Case& settings = setup.settings;
  const Real scale =
      settings.reference.half_model ? 2 / settings.reference.area : 1 / settings.reference.area;
  for (const auto& name : settings.mesh.aft_jets) {
    const Real area = comm.sum(part_aft_faces(setup.domain, name));
    setup.patch_kinds.push_back(BoundaryKind::jet);
    spdlog::info("{}: {:.3g} reference areas look aft and are a jet", aft_name(name), scale * area);
  }
}

/// The table of a motion from its text.
MotionTable table_of(const Case& settings, const std::string& text) {
  auto out = parse_motion_table(text, settings.motion.table_file);
  if (out.end < settings.unsteady.duration)
    throw InputError(settings.motion.table_file, 0,
                     fmt::format("the table ends at t_star = {:g}, before unsteady.duration", out.end),
                     "add points or shorten the duration");
  return out;
}

/// What the root reads of a case's files, with all that is wrong with them.
struct CaseFiles {
  bool mesh_is_prepared = false;
  MeshOfFile mesh;  ///< unless it is prepared
  std::string mesh_hash, table_text, gust_text;
  std::vector<Problem> problems;
};

/// Reads a mesh, or what stands before a prepared one, and looks whether its patches are those of the case.
void read_mesh_of(const Case& settings, const std::string& file, CaseFiles& out) {
  std::vector<std::string> patches;
  out.mesh_is_prepared = is_hdf5(file);
  if (out.mesh_is_prepared) {
    auto header = read_partitioned_mesh_header(file);
    patches = std::move(header.patch_names);
    out.mesh_hash = std::move(header.hash);
  } else {
    out.mesh = read_mesh(file);
    for (const auto& patch : out.mesh.patches) patches.push_back(patch.name);
  }
  if (!settings.boundary.empty()) add_patch_problems(settings, patches, out.problems);
  add_aft_problems(settings, patches, out.problems);
  if (out.mesh_is_prepared) return;
  for (auto& note : open_thin_walls(out.mesh, settings.mesh.thin)) out.mesh.notes.push_back(std::move(note));
  out.mesh.validate();
}

/// Where something is wrong already, the coarser meshes are looked at too, so that nothing comes to light
/// later.
CaseFiles read_files(const Case& settings, bool is_faulty) {
  CaseFiles out;
  collect(out.problems, [&] {
    if (!settings.mesh.file.empty()) read_mesh_of(settings, settings.mesh.file, out);
  });
  if (settings.motion.kind == MotionKind::table && !settings.motion.table_file.empty())
    collect(out.problems, [&] {
      out.table_text = read_file(settings.motion.table_file, "table of a motion", largest_table);
      table_of(settings, out.table_text);
    });
  if (settings.gust.kind == GustKind::table && !settings.gust.table_file.empty())
    collect(out.problems, [&] {
      out.gust_text = read_file(settings.gust.table_file, "table of a gust", largest_table);
      parse_gust_table(out.gust_text, settings.gust.table_file);
    });
  if (is_faulty || !out.problems.empty())
    for (const auto& file : settings.derivatives.coarser_meshes) {
      CaseFiles coarser;
      collect(coarser.problems, [&] { read_mesh_of(settings, file, coarser); });
      for (auto& problem : coarser.problems) {
        problem.what = fmt::format("derivatives.coarser_meshes, {}: {}",
                                   std::filesystem::path(file).filename().string(), problem.what);
        out.problems.push_back(std::move(problem));
      }
    }
  return out;
}

}  // namespace

std::vector<Problem> problems_of_files(const Case& settings) {
  return read_files(settings, true).problems;
}

Setup load_setup(const Case& settings, const Communicator& comm) {
  Setup out;
  out.settings = settings;
  out.mesh.file = settings.mesh.file;
  const Real before = resident_bytes();
  CaseFiles files;
  comm.on_root([&] {
    files = read_files(settings, false);
    if (!files.problems.empty()) throw InputError(std::move(files.problems));
    for (const auto& note : files.mesh.notes) spdlog::info("{}: {}", settings.mesh.file, note);
    if (!files.mesh_is_prepared) files.mesh_hash = files.mesh.hash();
  });
  out.domain = comm.any(files.mesh_is_prepared)
                   ? distribute(read_partitioned_mesh(settings.mesh.file, comm), comm, settings.mesh.scale)
                   : distribute(files.mesh, comm, settings.mesh.scale);
  files.mesh = {};
  const Real peak = std::max(peak_resident_bytes() - before, Real{0});
  out.memory = {comm.sum(static_cast<Real>(out.domain.bytes())), comm.sum(peak), comm.max(peak)};
  out.mesh.hash = comm.broadcast(files.mesh_hash);
  out.mesh.cells = out.domain.global_cells;
  out.mesh.points = out.domain.global_points;
  for (const auto& name : out.domain.patch_names) out.patch_kinds.push_back(settings.boundary.at(name));
  make_aft_jets(out, comm);
  if (settings.motion.kind == MotionKind::table) {
    files.table_text = comm.broadcast(files.table_text);
    comm.on_all([&] { out.motion_table = table_of(settings, files.table_text); });
  }
  if (settings.gust.kind == GustKind::table) {
    files.gust_text = comm.broadcast(files.gust_text);
    comm.on_all([&] { out.gust_table = parse_gust_table(files.gust_text, settings.gust.table_file); });
  }
  if (const std::string text = files.table_text + files.gust_text; !text.empty())
    out.motion_table_hash = content_hash(text);
  out.configuration = survey(out.domain, out.patch_kinds, settings, comm);
  comm.on_all([&] {
    auto [problems, warnings] = judge(out.configuration, out.domain.patch_names, out.patch_kinds, settings,
                                      settings.mesh.scale, settings.file);
    if (!problems.empty()) throw InputError(std::move(problems));
    out.warnings = std::move(warnings);
    if (auto shortfall = response_shortfall(settings, out.configuration); !shortfall.empty())
      out.warnings.push_back("no derivatives will be had: " + shortfall);
  });
  return out;
}

}  // namespace alphadot
