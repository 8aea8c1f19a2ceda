#include "app/run_folder.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sys/stat.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string_view>
#include <utility>
#include <vector>

#include "case_file/case_difference.hpp"
#include "case_file/case_file.hpp"
#include "core/error.hpp"
#include "core/run_status.hpp"
#include "io/checkpoint_folder.hpp"
#include "io/files.hpp"

namespace alphadot {

namespace {

namespace fs = std::filesystem;

/// A file, or the folder of a coarser mesh, that runs write, and the verb whose it is alone.
struct Output {
  std::string_view name, verb;
};

constexpr std::string_view result_name = "result.json", steady_name = "steady.csv";
constexpr Output outputs[] = {{result_name, ""},
                              {resolved_case_name, ""},
                              {steady_name, ""},
                              {"worst_cells.csv", ""},
                              {"flow.vtkhdf", ""},
                              {"surface.vtkhdf", ""},
                              {"symmetry.vtkhdf", ""},
                              {"history.h5", "run"},
                              {"history.csv", "run"},
                              {"derivatives.csv", "derivatives"},
                              {"derivatives.stability_axes.csv", "derivatives"},
                              {"derivatives.st", "derivatives"},
                              {"components.csv", "derivatives"},
                              {"panels.csv", "derivatives"},
                              {"along_body.csv", "derivatives"},
                              {"along_panels.csv", "derivatives"},
                              {"derivatives.jsbsim.xml", "derivatives"},
                              {"mesh_2", "derivatives"},
                              {"mesh_3", "derivatives"},
                              {"adjoint.csv", "adjoint"},
                              {"adjoint.vtkhdf", "adjoint"},
                              {"indicator.vtkhdf", "adjoint"},
                              {"frequency.csv", "frequency"},
                              {"surface_sensitivity.csv", "adjoint"},
                              {"surface_sensitivity.vtkhdf", "adjoint"}};

/// Whether a run of the verb replaces what it and others of its verb may have written.
bool is_written(const Output& output, const std::string& verb, const Case& settings) {
  if (output.verb.empty()) return true;
  if (output.verb != verb) return false;
  if (verb == "run") return goes_on_in_time(settings);
  for (std::size_t number : {2, 3})
    if (output.name == fmt::format("mesh_{}", number))
      return settings.derivatives.coarser_meshes.size() + 1 >= number;
  return true;
}

/// A text that is another one after the file has been written to or replaced; empty where there is none. Of a
/// folder that of its result.
std::string mark_of(const fs::path& path) {
  struct stat found {};
  if (stat(path.c_str(), &found) != 0) return "";
  if (S_ISDIR(found.st_mode)) {
    const auto inside = mark_of(path / result_name);
    std::error_code error;
    return inside.empty() && !fs::is_empty(path, error) ? "folder" : inside;
  }
  if (!S_ISREG(found.st_mode)) return "";  // such as a pipe that somebody looks on through
  return fmt::format("{} {}.{} {}", found.st_ino, found.st_mtim.tv_sec, found.st_mtim.tv_nsec, found.st_size);
}

std::string text_of(const nlohmann::json& json, const char* key) {
  const auto found = json.is_object() ? json.find(key) : json.end();
  return found != json.end() && found->is_string() ? found->get<std::string>() : "";
}

/// What tells the result that stands there from what the new run is about, one phrase a difference.
std::vector<std::string> other_than(const nlohmann::json& result, const Setup& setup,
                                    const std::string& verb) {
  if (text_of(result, "case").empty() || !result.contains("mesh")) return {"it does not say what it is of"};
  std::vector<std::string> out;
  Case before;
  try {
    before = parse_case(text_of(result, "case"), "");
  } catch (const InputError&) {
    return {"its case is of another version"};
  }
  if (const auto hash = text_of(result.at("mesh"), "hash"); hash != setup.mesh.hash)
    out.push_back(fmt::format("it is of another mesh, {} with hash {}", before.mesh.file, hash));
  const bool has_motion = text_of(result, "verb") == "run" && verb == "run" && goes_on_in_time(before);
  for (const auto& [key, there, here] :
       differences(before, setup.settings, has_motion ? Shared::motion : Shared::flow))
    out.push_back(fmt::format("its {} is {}, not {}", key, there, here));
  if (has_motion && text_of(result, "motion_table_hash") != setup.motion_table_hash)
    out.push_back("the table of its motion has other content");
  return out;
}

}  // namespace

RunFolder::RunFolder(std::string folder) : folder_(std::move(folder)), lock_(folder_) {
  for (const auto& output : outputs)
    if (auto mark = mark_of(fs::path(folder_) / output.name); !mark.empty())
      before_[std::string(output.name)] = std::move(mark);
}

void RunFolder::refuse_inputs(const Setup& setup) const {
  const Case& settings = setup.settings;
  std::vector<std::string> inputs{settings.file, settings.mesh.file, settings.motion.table_file};
  inputs.insert(inputs.end(), settings.derivatives.coarser_meshes.begin(),
                settings.derivatives.coarser_meshes.end());
  std::vector<Problem> problems;
  for (const auto& input : inputs) {
    const auto name = fs::path(input).filename().string();
    const bool is_output =
        std::ranges::find(outputs, name, &Output::name) != std::end(outputs) || is_checkpoint_name(name);
    std::error_code error;
    if (is_output && fs::equivalent(input, fs::path(folder_) / name, error))
      problems.push_back({input, 0, "the run would replace this file, which it reads",
                          "rename it, or choose another folder with --out DIR"});
  }
  if (!problems.empty()) throw InputError(std::move(problems));
}

void RunFolder::admit(const Setup& setup, const std::string& verb, bool may_overwrite) {
  refuse_inputs(setup);
  const auto result = nlohmann::json::parse(content_of(fs::path(folder_) / result_name), nullptr, false);
  const auto status = text_of(result, "status");
  for (const auto end : {RunStatus::converged, RunStatus::completed, RunStatus::unconverged})
    if (status == to_string(end)) holds_result_ = true;
  std::vector<std::string> reasons, others;
  const bool has_checkpoints = !CheckpointFolder(folder_, 1).empty();
  if (holds_result_ || (has_checkpoints && !status.empty())) {
    for (const auto& reason : other_than(result, setup, verb))
      reasons.push_back(fmt::format("{}: {}", result_name, reason));
  }
  if (!reasons.empty()) {
    holds_other_ = true;
    for (const auto& entry : fs::directory_iterator(folder_))
      if (const auto name = entry.path().filename().string(); is_checkpoint_name(name))
        before_[name] = mark_of(entry.path());
  }
  for (const auto& output : outputs)
    if (before_.contains(std::string(output.name)) && output.name != steady_name &&
        (status.empty() || !is_written(output, verb, setup.settings)))
      others.emplace_back(output.name);
  if (!others.empty())
    reasons.push_back(status.empty() ? fmt::format("{}: of no result that is there", fmt::join(others, ", "))
                                     : fmt::format("{}: no file of this run", fmt::join(others, ", ")));
  if (!reasons.empty() && !may_overwrite)
    throw InputError(folder_, 0, fmt::format("the folder holds other results ({})", fmt::join(reasons, "; ")),
                     "choose another with --out DIR, or let the run replace them with --overwrite");
}

void RunFolder::remove_stale(bool goes_on) const {
  std::error_code ignored;
  for (const auto& [name, mark] : before_) {
    const auto path = fs::path(folder_) / name;
    if (mark == mark_of(path) && !(goes_on && name == steady_name)) fs::remove_all(path, ignored);
  }
}

}  // namespace alphadot
