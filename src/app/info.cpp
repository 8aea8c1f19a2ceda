// The verb "info": what a file is and holds.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "app/extraction.hpp"
#include "app/verbs.hpp"
#include "core/error.hpp"
#include "io/mesh_reader.hpp"

namespace alphadot {

namespace {

void describe_mesh(const std::string& file) {
  const Mesh mesh = read_mesh(file);
  mesh.validate();
  fmt::print("mesh {}: {} tetrahedra, {} points, hash {}\n", file, mesh.cells.size(), mesh.points.size(),
             mesh.hash());
  for (const auto& patch : mesh.patches)
    fmt::print("  patch {}: {} triangles\n", patch.name, patch.triangles.size());
}

void describe_history(const std::string& file) {
  const History history = read_history(file);
  const auto& info = history.info;
  fmt::print(
      "history {}: {} steps, {} at k = {}, Mach {}, mesh {}, written by alphadot {}\n  columns: {}\n  {}\n",
      file, history.steps(), motion_name(info.motion.kind), info.motion.reduced_frequency,
      info.freestream.mach, info.mesh_hash, info.version, fmt::join(history.names(), " "), info.conventions);
}

void describe_result(const std::string& file) {
  std::ifstream in(file);
  const auto json = nlohmann::json::parse(in, nullptr, false);
  if (json.is_discarded() || !json.contains("status"))
    throw InputError(file, 0, "this is not a result of alphadot", "give the result.json of a run's folder");
  fmt::print("{}\n", json.dump(2));
}

}  // namespace

RunStatus info_verb(const std::string& file, const Communicator& comm) {
  comm.on_root([&] {
    if (!std::filesystem::is_regular_file(file))
      throw InputError(file, 0, "there is no such file", "check the path");
    const std::string extension = std::filesystem::path(file).extension();
    if (extension == ".h5")
      describe_history(file);
    else if (extension == ".json")
      describe_result(file);
    else
      describe_mesh(file);
  });
  return RunStatus::completed;
}

}  // namespace alphadot
