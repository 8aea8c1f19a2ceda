// The verb "info": what a file is and holds.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "app/verbs.hpp"
#include "core/error.hpp"
#include "derivatives/extraction.hpp"
#include "io/checkpoint.hpp"
#include "io/files.hpp"
#include "io/foreign_files.hpp"
#include "io/mesh_reader.hpp"
#include "io/partitioned_mesh.hpp"
#include "io/seal.hpp"

namespace alphadot {

namespace {

void describe_mesh(const std::string& file) {
  const MeshOfFile mesh = read_mesh(file);
  for (const auto& note : mesh.notes) fmt::print("{}\n", note);
  mesh.validate();
  fmt::print("mesh {}: {} tetrahedra, {} points, hash {}\n", file, mesh.cells.size(), mesh.points.size(),
             mesh.hash());
  for (const auto& patch : mesh.patches)
    fmt::print("  patch {}: {} triangles\n", patch.name, patch.triangles.size());
}

void describe_partitioned_mesh(const std::string& file) {
  const auto header = read_partitioned_mesh_header(file);
  fmt::print(
      "mesh {}: {} tetrahedra, {} points, {} boundary triangles, in {} pieces, hash {}\n  patches: {}\n",
      file, header.cells, header.points, header.triangles, header.pieces(), header.hash,
      fmt::join(header.patch_names, ", "));
}

void describe_history(const std::string& file) {
  const History history = read_history(file);
  const auto& info = history.info;
  fmt::print(
      "history {}: {} steps, {} at k = {}, Mach {}, mesh {}, written by alphadot {}\n  columns: {}\n  {}\n",
      file, history.steps(), word_of(info.motion.kind), info.motion.reduced_frequency, info.freestream.mach,
      info.mesh_hash, info.version, fmt::join(history.names(), " "), info.conventions);
}

/// Where the march of a checkpoint stands.
std::string place_of(const CheckpointHead& head) {
  const auto number = [&](const char* name, std::size_t i = 0) { return head.numbers.at(name).at(i); };
  if (head.phase == "motion") {
    const auto& history = head.history;
    const Real time = history.steps() > 0 ? history.column("t_star").back() : 0;
    return fmt::format("motion ({}), step {}, t* = {:.6g}", word_of(history.info.motion.kind), number("step"),
                       time);
  }
  const auto drop = std::log10(number("residuals", 0) / std::max(number("residuals", 1), 1e-300));
  return fmt::format("{}, iteration {}, residual down by {:.2f} decades, CFL {:.3g}",
                     head.phase == "steady" ? "steady march" : "linear solves about the steady state",
                     number("iteration"), drop, number("cfl"));
}

void describe_checkpoint(const std::string& file) {
  try {
    check_seal(file);
  } catch (const InputError& error) {
    throw InputError(file, 0, "not a whole checkpoint: it " + error.problems().front().what,
                     "go on from an older one; flow.vtkhdf and surface.vtkhdf are for ParaView");
  }
  const auto head = read_checkpoint_head(file);
  const auto states = read_checkpoint_states(file);
  const auto& info = head.history.info;
  fmt::print(
      "checkpoint {}: whole, its seal matches\n  phase: {}\n  mesh: {} cells, hash {}\n  states: {}\n"
      "  history: {} steps\n  written by alphadot {}\n",
      file, place_of(head), states.cells, info.mesh_hash, fmt::join(states.names, " "), head.history.steps(),
      info.version);
  if (!head.message.empty()) fmt::print("  message: {}\n", head.message);
  fmt::print("  case:\n\n{}", info.case_text);
}

void describe_result(const std::string& file) {
  const auto json = nlohmann::json::parse(read_file(file, "result"), nullptr, false);
  if (json.is_discarded() || !json.contains("status"))
    throw InputError(file, 0, "this is not a result of alphadot", "give the result.json of a run's folder");
  fmt::print("{}\n", json.dump(2));
}

}  // namespace

RunStatus info_verb(const std::string& file, const Communicator& comm) {
  comm.on_root([&] {
    if (!std::filesystem::exists(file)) throw InputError(file, 0, "there is no such file", "check the path");
    const std::string extension = std::filesystem::path(file).extension();
    if (is_partitioned_mesh(file))
      describe_partitioned_mesh(file);
    else if (extension == ".h5" && !foreign_name(file, in_lower_case(file)))
      describe_history(file);
    else if (extension == ".json")
      describe_result(file);
    else if (extension == ".vtkhdf")
      describe_checkpoint(file);
    else
      describe_mesh(file);
  });
  return RunStatus::completed;
}

}  // namespace alphadot
