#include "app/described_case.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <optional>
#include <sstream>

#include "app/companion.hpp"
#include "core/error.hpp"
#include "core/log.hpp"

namespace alphadot {

namespace {

/// Has the text a line that begins a body's segment, or names a body's surface? Case files have none.
bool describes_body(std::istream& text) {
  for (std::string line; std::getline(text, line);) {
    std::erase_if(line, [](unsigned char c) { return std::isspace(c); });
    if (line.starts_with("[[body]]") || line.starts_with("[surface]")) return true;
  }
  return false;
}

bool is_description(const std::filesystem::path& file) {
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

}  // namespace

void mesh_description(CaseArguments& arguments, const Communicator& comm) {
  std::string made;
  comm.on_root([&] {
    const auto& file = arguments.case_file;
    if (file.empty() || !is_description(file)) return;
    std::vector<std::string> words{file, "--kept", "--level",
                                   overridden(arguments.overrides, "mesh.level").value_or("coarse")};
    if (const auto mach = overridden(arguments.overrides, "freestream.mach")) {
      words.emplace_back("--at-mach");
      words.push_back(*mach);
    }
    spdlog::info("{}: meshed, unless that was done before", file);
    made = output_of_companion("mesh.py", words);
    if (!std::filesystem::exists(made))
      throw InputError(file, 0, "has not been meshed", "see the lines above");
  });
  made = comm.broadcast(made);
  if (made.empty()) return;
  arguments.case_file = made;
  std::erase_if(arguments.overrides, [](const std::string& text) { return text.starts_with("mesh.level="); });
}

}  // namespace alphadot
