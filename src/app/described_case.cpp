#include "app/described_case.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <optional>

#include "app/companion.hpp"
#include "core/error.hpp"
#include "core/log.hpp"
#include "core/words.hpp"

namespace alphadot {

namespace fs = std::filesystem;

namespace {

/// Has the text a line that begins a body's segment, or names a body's surface? Case files have none.
bool describes_body(std::istream& text) {
  for (std::string line; std::getline(text, line);) {
    std::erase_if(line, [](unsigned char c) { return std::isspace(c); });
    if (line.starts_with("[[body]]") || line.starts_with("[surface]")) return true;
  }
  return false;
}

bool is_description(const fs::path& file) {
  constexpr std::array designs{".ork", ".cdx1", ".step", ".stp", ".iges",
                               ".igs", ".brep", ".stl",  ".obj", ".tri"};
  std::string suffix = file.extension().string();
  std::ranges::transform(suffix, suffix.begin(), [](unsigned char c) { return std::tolower(c); });
  if (std::ranges::find(designs, suffix) != designs.end()) return true;
  std::ifstream text(file);
  return suffix == ".toml" && text && describes_body(text);
}

/// The value of the last override of a key.
std::optional<std::string> overridden(const std::vector<std::string>& overrides, const std::string& key) {
  std::optional<std::string> out;
  for (const auto& text : overrides)
    if (text.starts_with(key + "=")) out = text.substr(key.size() + 1);
  return out;
}

/// Has a description meshed, or finds what was made before: the case file that came of it, in the folder of
/// the meshes.
fs::path kept_case(const std::string& description, const std::string& level, const std::string& mach,
                   const std::string& model) {
  std::vector<std::string> words{description, "--kept", "--level", level};
  if (!mach.empty()) words.insert(words.end(), {"--at-mach", mach});
  if (!model.empty()) words.insert(words.end(), {"--model", model});
  spdlog::info("{}: meshed, unless that was done before", description);
  fs::path made = output_of_companion("mesh.py", words);
  if (!fs::exists(made)) throw InputError(description, 0, "has not been meshed", "see the lines above");
  return made;
}

}  // namespace

void replace_description(CaseArguments& arguments, const Communicator& comm) {
  std::string made;
  comm.on_root([&] {
    const auto& file = arguments.case_file;
    if (file.empty() || !is_description(file)) return;
    made = kept_case(file, overridden(arguments.overrides, "mesh.level").value_or("coarse"),
                     overridden(arguments.overrides, "freestream.mach").value_or(""), "");
  });
  made = comm.broadcast(made);
  if (made.empty()) return;
  arguments.case_file = made;
  std::erase_if(arguments.overrides, [](const std::string& text) { return text.starts_with("mesh.level="); });
}

void make_mesh(Case& c, const Communicator& comm) {
  if (c.mesh.from.empty()) return;
  std::string folder;
  comm.on_root([&] {
    folder = kept_case(c.mesh.from, std::string(word_of(c.mesh.level)), fmt::format("{}", c.freestream.mach),
                       c.reference.half_model ? "half" : "full")
                 .parent_path();
  });
  folder = comm.broadcast(folder);
  const auto file = [&](Fineness level) { return fmt::format("{}/{}.msh", folder, word_of(level)); };
  c.mesh.from.clear();
  c.mesh.file = file(c.mesh.level);
  if (c.derivatives.coarser_meshes.empty() && c.mesh.level != Fineness::tiny)
    c.derivatives.coarser_meshes = {file(static_cast<Fineness>(static_cast<int>(c.mesh.level) - 1))};
}

}  // namespace alphadot
