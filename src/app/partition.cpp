// The verb "partition": a mesh prepared for reading by many ranks at once.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <span>
#include <string>
#include <utility>

#include "app/verbs.hpp"
#include "core/error.hpp"
#include "core/log.hpp"
#include "core/memory.hpp"
#include "core/timer.hpp"
#include "io/mesh_reader.hpp"
#include "io/partitioned_mesh.hpp"
#include "partition/decompose.hpp"
#include "partition/refine.hpp"
#include "partition/reorder.hpp"
#include "partition/slabs.hpp"
#include "partition/thin_walls.hpp"

namespace alphadot {

namespace {

/// Any mesh, in equal stretches of its order (a prepared one: of its pieces).
MeshPart read_part(const std::string& file, std::span<const std::string> thin, const Communicator& comm) {
  bool prepared = false;
  comm.on_root([&] {
    prepared = is_hdf5(file);
    if (prepared && !thin.empty())
      throw InputError(file, 0, "--thin is for meshes as they come from a generator, not for prepared ones",
                       "give the mesh that this one was made of");
  });
  if (comm.any(prepared)) return read_partitioned_mesh(file, comm);
  MeshOfFile mesh;
  std::vector<int> owner;
  comm.on_root([&] {
    mesh = read_mesh(file);
    for (auto& note : open_thin_walls(mesh, thin)) mesh.notes.push_back(std::move(note));
    for (const auto& note : mesh.notes) spdlog::info("{}: {}", file, note);
    mesh.validate();
    const EqualSlabs slabs(static_cast<GlobalIndex>(mesh.cells.size()), comm.size());
    for (GlobalIndex cell = 0; cell < slabs.total; ++cell) owner.push_back(slabs.rank_of(cell));
  });
  return scatter(mesh, owner, comm);
}

std::string output_of(const PartitionArguments& arguments) {
  if (!arguments.output.empty()) return arguments.output;
  return std::filesystem::path(arguments.mesh).replace_extension(".h5");
}

/// Also one that is damaged, which is to be made anew.
bool is_or_was_prepared(const std::string& file) {
  try {
    return is_partitioned_mesh(file);
  } catch (const InputError&) {
    return true;
  }
}

void check_arguments(const PartitionArguments& arguments) {
  const auto output = output_of(arguments);
  std::error_code error;
  if (std::filesystem::equivalent(arguments.mesh, output, error))
    throw InputError(output, 0, "the prepared mesh would replace the mesh itself",
                     "name another file with --output");
  if (std::filesystem::exists(output, error) && !is_or_was_prepared(output))
    throw InputError(output, 0, "this file is no prepared mesh, and would be replaced by one",
                     "name another file with --output");
}

}  // namespace

RunStatus partition_verb(const PartitionArguments& arguments, const Communicator& comm) {
  const Timer time;
  comm.on_root([&] { check_arguments(arguments); });
  MeshPart part = read_part(arguments.mesh, arguments.thin, comm);
  for (int level = 0; level < arguments.refinements; ++level) part = refine(std::move(part), comm);
  auto points = part.points;
  const auto file = part.file;
  const RankMesh rank_mesh = gather_rank_mesh(std::move(part), comm);
  const auto piece = decompose(rank_mesh, arguments.pieces, arguments.partitioner, file, comm);
  const auto mesh = reorder(rank_mesh, piece, arguments.pieces, std::move(points), comm);
  const auto hash = write_partitioned_mesh(output_of(arguments), mesh, comm);

  GlobalIndex largest = 0;
  for (std::size_t i = 0; i + 1 < mesh.piece_begin.size(); ++i)
    largest = std::max(largest, mesh.piece_begin[i + 1] - mesh.piece_begin[i]);
  const auto cells = static_cast<Real>(rank_mesh.global_cells);
  spdlog::info(
      "{}: {} cells, {} points in {} pieces, the largest {:.2f} % above the mean; hash {}\n{:.0f} s, at most "
      "{:.2f} GB on a rank",
      output_of(arguments), rank_mesh.global_cells, rank_mesh.global_points, arguments.pieces,
      100 * (static_cast<Real>(largest) * arguments.pieces / cells - 1), hash, time.wall(),
      1e-9 * comm.max(peak_resident_bytes()));
  return RunStatus::completed;
}

}  // namespace alphadot
