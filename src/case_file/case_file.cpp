#include "case_file/case_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <deque>
#include <filesystem>
#include <map>
#include <set>
#include <tuple>

#include "analysis/derivatives.hpp"
#include "case_file/case_keys.hpp"
#include "case_file/suggestion.hpp"
#include "core/error.hpp"
#include "core/fit_needs.hpp"
#include "io/files.hpp"
#include "io/history.hpp"
#include "io/toml_text.hpp"
#include "motion/rigid_body.hpp"

namespace alphadot {
namespace {

namespace fs = std::filesystem;

constexpr std::uintmax_t largest_file = 1 << 20;  ///< bytes
constexpr std::size_t most_problems = 50;         ///< that one message tells of

/// A key that is none of ours, with the one that was probably meant.
Problem unknown_key(const std::string& path, int line) {
  const std::string name = path.substr(path.rfind('.') + 1);
  const std::string prefix = path.substr(0, path.size() - name.size());
  std::vector<std::string> siblings;
  std::string meant;
  for (const auto& key : case_keys()) {
    if (key.name() == name) meant = key.path;  // the right name in the wrong table, or in none
    if (key.table() == prefix)
      siblings.emplace_back(key.name());
    else if (prefix.empty())
      siblings.emplace_back(key.table().substr(0, key.table().size() - 1));
  }
  if (const auto sibling = nearest(name, siblings); meant.empty() && !sibling.empty())
    meant = prefix + sibling;
  const std::string shown = path.size() <= 80 ? path : path.substr(0, 80) + "...";
  return {"", line, "unknown key " + shown,
          meant.empty() ? "alphadot keys lists the keys" : "did you mean " + meant + "?"};
}

bool is_table(const std::string& path) {
  return std::ranges::any_of(case_keys(),
                             [&](const auto& key) { return key.table().starts_with(path + "."); });
}

/// {value = ...} from the right-hand side of an override, as TOML or else as text; nothing when it can be
/// neither.
std::optional<toml::table> override_value(const std::string& text, bool wants_text) {
  for (const auto& value : {text, toml_string(text)}) {
    const std::string line = "value = " + value;
    if (unsafe_line(line).line > 0) continue;
    try {
      auto table = toml::parse(line);
      if (table.size() == 1 && (!wants_text || table.get("value")->is_string())) return table;
    } catch (const toml::parse_error&) {
      continue;  // not TOML as it stands: the second round takes it as text
    }
  }
  return std::nullopt;
}

/// Reads one case: collects what the file and the overrides say key by key, then everything that is wrong
/// with it.
class CaseReader {
 public:
  explicit CaseReader(std::string path) : path_(std::move(path)) {}

  void add_text(std::string_view text) {
    auto problem = unsafe_line(text);
    if (problem.line == 0) {
      try {
        file_ = toml::parse(text);
        return collect("", file_);
      } catch (const toml::parse_error& error) {
        problem.line = static_cast<int>(error.source().begin.line);
        problem.what = error.description();
      }
    }
    complain(path_, std::move(problem));
    unreadable_ = true;
  }

  void add_override(const std::string& assignment) {
    const std::string place = "--set " + assignment;
    const auto equals = assignment.find('=');
    if (equals == std::string::npos)
      return complain(place, {"", 0, "is not of the form key=value", "for example --set freestream.mach=2"});
    const std::string path = assignment.substr(0, equals);
    const auto* key = find_case_key(path);
    if (!key && is_table(path)) return add_table_override(path, assignment.substr(equals + 1), place);
    if (!key) return complain(place, unknown_key(path, 0));
    auto value = override_value(assignment.substr(equals + 1), key->is_text);
    if (!value) return complain(place, {"", 0, "the value is not valid text", ""});
    overrides_.push_back(std::move(*value));
    entries_[path] = {key, overrides_.back().get("value"), place, 0};
  }

  /// All of a table whose keys are names, in place of what was there.
  void add_table_override(const std::string& path, const std::string& text, const std::string& place) {
    const auto* family = find_case_key(path + ".name");
    auto value = override_value(text, false);
    const auto* table = value ? (*value)["value"].as_table() : nullptr;
    if (!family || !family->is_family() || !table)
      return complain(place,
                      {"", 0, path + " is a table", "set its keys one by one: --set " + path + ".KEY=..."});
    overrides_.push_back(std::move(*value));
    std::erase_if(entries_, [&](const auto& entry) { return entry.second.key == family; });
    for (const auto& [name, node] : *overrides_.back()["value"].as_table())
      entries_[path + "." + std::string(name.str())] = {family, &node, place, 0};
  }

  CaseDraft finish() {
    CaseDraft out;
    Case& c = out.settings;
    c.file = path_;
    choose_mesh();
    for (const auto& [path, entry] : entries_) {
      const auto name = std::string_view(path).substr(entry.key->table().size());
      if (auto problem = entry.key->read(name, *entry.node, c))
        complain(entry.place, {"", entry.line > 0 && problem->line > 0 ? problem->line : entry.line,
                               path + " " + problem->what, problem->remedy});
      if (entry.key->table() == "boundary." && entry.line > 0)
        c.boundary_lines[std::string(name)] = entry.line;
    }
    if (!unreadable_) {
      check_required();
      check_together(c);
    }
    fill_in(c);
    out.is_readable = !unreadable_;
    out.problems = sorted_problems();
    return out;
  }

 private:
  /// What was said about a key, and where: in the file, or by the override that is its place.
  struct Entry {
    const CaseKey* key = nullptr;
    const toml::node* node = nullptr;
    std::string place;
    int line = 0;
  };

  void complain(const std::string& place, Problem problem) {
    if (problems_.size() == most_problems) {
      ++left_out_;
      return;
    }
    problem.file = place;
    problems_.push_back(std::move(problem));
  }

  /// A problem with a combination of keys, placed at the first of `paths` that was given.
  void complain_about(const std::vector<std::string>& paths, std::string what, std::string remedy = "") {
    Entry entry{nullptr, nullptr, path_, 0};
    for (auto path = paths.rbegin(); path != paths.rend(); ++path)
      if (const auto found = entries_.find(*path); found != entries_.end()) entry = found->second;
    complain(entry.place, {"", entry.line, std::move(what), std::move(remedy)});
  }

  void collect(const std::string& prefix, const toml::table& table) {
    for (const auto& [key, node] : table) {
      const std::string path = prefix + std::string(key.str());
      const int line = static_cast<int>(key.source().begin.line);
      if (const auto* known = find_case_key(path))
        entries_[path] = {known, &node, path_, line};
      else if (!is_table(path))
        complain(path_, unknown_key(path, line));
      else if (const auto* inner = node.as_table())
        collect(path + ".", *inner);
      else
        complain(path_, {"", line, path + " must be a table", "write [" + path + "]"});
    }
  }

  /// mesh.file and mesh.from exclude each other: an override of either is in place of what the file says.
  void choose_mesh() {
    const auto is_given = [&](const char* key) {
      const auto entry = entries_.find(key);
      return entry != entries_.end() && entry->second.node->value<std::string>() != "";
    };
    if (!is_given("mesh.from")) {
      entries_.erase("mesh.from");
    } else if (!is_given("mesh.file")) {
      entries_.erase("mesh.file");
    } else {
      const bool from_in_file = entries_["mesh.from"].line > 0, file_in_file = entries_["mesh.file"].line > 0;
      if (from_in_file != file_in_file)
        entries_.erase(from_in_file ? "mesh.from" : "mesh.file");
      else
        complain_about({"mesh.from"}, "mesh.from and mesh.file are both given", "leave out either of them");
    }
  }

  void check_required() {
    for (const auto& key : case_keys()) {
      if (key.path == "mesh.file" && entries_.contains("mesh.from")) continue;
      const auto is_given = [&](const auto& path_and_entry) { return path_and_entry.second.key == &key; };
      if (!key.required || std::ranges::any_of(entries_, is_given)) continue;
      const std::string table(key.table().substr(0, key.table().size() - 1));
      const auto* node = file_.get(table);
      const int line = node ? static_cast<int>(node->source().begin.line) : 0;
      if (key.is_family())
        complain(path_, {"", line, "[" + table + "] is missing or empty",
                         "give each patch of the mesh " + key.type});
      else
        complain(path_, {"", line, key.path + " is missing", "give " + key.type + ": " + key.doc});
    }
  }

  /// Sets of walls, under names of their own.
  void check_components(const Case& c) {
    for (const auto& [name, patches] : c.components) {
      const std::string key = "components." + name;
      if (c.boundary.contains(name) || is_reserved_component(name))
        complain_about({key},
                       fmt::format("{} has the name of {} already", key,
                                   c.boundary.contains(name) ? "a patch" : "a column"),
                       "give the set another name");
      if (name.empty()) complain_about({key}, "components: a set has no name", "give it one");
      if (patches.empty()) complain_about({key}, key + " has no walls", "name some, or leave it out");
      for (const auto& patch : patches)
        if (const auto kind = c.boundary.find(patch);
            kind == c.boundary.end() || kind->second != BoundaryKind::wall)
          complain_about({key}, fmt::format("{} names \"{}\", which is no wall of the case", key, patch),
                         "name patches that [boundary] makes walls");
      if (std::set<std::string>(patches.begin(), patches.end()).size() != patches.size())
        complain_about({key}, key + " names a wall twice", "name each once");
    }
  }

  /// Where the controls themselves are wrong any name is as good as theirs.
  bool is_control(const Case& c, const std::string& name) const {
    return (c.controls.empty() && entries_.contains("controls")) ||
           std::ranges::find(c.controls, name, &ControlSettings::name) != c.controls.end();
  }

  /// Walls that turn, under names of their own, and sets of them.
  void check_controls(const Case& c) {
    std::set<std::string> names;
    const auto check_name = [&](const std::string& key, const std::string& name) {
      if (!is_control_name(name))
        complain_about(
            {key}, fmt::format("{}: {} cannot name a control", key, toml_string(name)),
            "take letters, digits and underscores, a letter first; no flight variable, and not ...dot");
      if (!names.insert(name).second)
        complain_about({key}, fmt::format("{}: there are two controls {}", key, toml_string(name)),
                       "give each a name of its own");
    };
    for (const auto& control : c.controls) {
      const std::string about = "controls: " + toml_string(control.name);
      check_name("controls", control.name);
      if (control.patches.empty()) complain_about({"controls"}, about + " has no patches", "name some");
      for (const auto& patch : control.patches) {
        const auto kind = c.boundary.find(patch);
        if (kind == c.boundary.end() || kind->second == BoundaryKind::farfield ||
            kind->second == BoundaryKind::symmetry)
          complain_about({"controls"},
                         fmt::format("{} names {}, which is no wall of the case", about, toml_string(patch)),
                         "name patches that [boundary] makes walls, stings or jets");
      }
      if (std::set<std::string>(control.patches.begin(), control.patches.end()).size() !=
          control.patches.size())
        complain_about({"controls"}, about + " names a wall twice", "name each once");
      if (norm(control.hinge_axis) == 0)
        complain_about({"controls"}, about + ": the axis of the hinge has no direction",
                       "give hinge.axis, for a panel outboard along its hinge line");
    }
    for (const auto& [name, shares] : c.control_sets) {
      const std::string key = "control_sets." + name;
      check_name(key, name);
      if (shares.empty()) complain_about({key}, key + " has no controls", "name some, or leave it out");
      for (const auto& [control, share] : shares)
        if (!is_control(c, control))
          complain_about({key}, fmt::format("{} names {}, which is no control", key, toml_string(control)),
                         "name controls of [[controls]]");
    }
  }

  void check_deflections(const Case& c) {
    for (const auto& [name, degrees] : c.deflections)
      if (!is_control(c, name))
        complain_about({"deflections." + name}, fmt::format("deflections.{} names no control", name),
                       "name controls of [[controls]]");
    if (c.space.deflection == DeflectionKind::transpiration && !c.deflections.empty() &&
        c.motion.treatment != TreatmentKind::field_velocity)
      complain_about({"space.deflection", "motion.treatment"},
                     "walls turn by transpiration on a mesh that stays only",
                     "leave out motion.treatment, or set space.deflection = \"mesh\"");
  }

  /// What no single key can tell.
  void check_together(const Case& c) {
    check_components(c);
    check_controls(c);
    check_deflections(c);
    const auto kind = c.motion.kind;
    const std::string motion = "motion.kind = " + toml_string(word_of(kind));
    if (c.steady.cfl_max < c.steady.cfl_start)
      complain_about({"steady.cfl_max", "steady.cfl_start"}, "steady.cfl_max is below steady.cfl_start");
    if (c.reference.half_model && c.freestream.beta != 0)
      complain_about({"freestream.beta"}, "a half model has no sideslip", "use a full model or beta = 0");
    if (c.reference.half_model &&
        (kind == MotionKind::sway || kind == MotionKind::yaw || kind == MotionKind::roll))
      complain_about({"motion.kind"}, motion + " needs a full model", "set reference.model = \"full\"");
    if (kind == MotionKind::table && c.motion.table_file.empty())
      complain_about({"motion.kind"}, motion + " needs motion.table_file");
    if (kind != MotionKind::none && kind != MotionKind::free && norm(c.motion.rotation) != 0)
      complain_about({"motion.rotation"}, "a steady rotation excludes " + motion, "leave out either of them");
    if (c.reference.half_model && (c.motion.rotation.x != 0 || c.motion.rotation.z != 0))
      complain_about({"motion.rotation"}, "a half model can only rotate in pitch",
                     "set reference.model = \"full\"");
    const bool has_duration = kind == MotionKind::step_alpha || kind == MotionKind::ramp_alpha ||
                              kind == MotionKind::step_q || kind == MotionKind::table ||
                              kind == MotionKind::free;
    if (has_duration && c.unsteady.duration <= 0)
      complain_about({"unsteady.duration", "motion.kind"}, motion + " needs unsteady.duration > 0");
    if ((kind == MotionKind::table || kind == MotionKind::free) && c.unsteady.steps < 1)
      complain_about({"unsteady.steps", "motion.kind"}, motion + " needs unsteady.steps >= 1");
    if (kind == MotionKind::free) check_body(c);
    check_gust(c);
    check_estimates(c);
    check_derivatives(c);
  }

  /// A body that flies freely has inertia where it may move, and loads that move it.
  void check_body(const Case& c) {
    const auto& free = c.body.free;
    const auto properties = properties_of(c.body, 1, 1);
    if (free.empty())
      complain_about({"body.free", "motion.kind"}, "motion.kind = \"free\" needs body.free",
                     "name what the body may do: free = [\"pitch\"]");
    if (c.motion.treatment != TreatmentKind::field_velocity)
      complain_about({"motion.treatment"}, "a body flies freely by field velocity only",
                     "leave out motion.treatment");
    for (const FreedomKind freedom : {FreedomKind::sway, FreedomKind::roll, FreedomKind::yaw})
      if (c.reference.half_model && std::ranges::find(free, freedom) != free.end())
        complain_about({"body.free"}, "a half model has no " + word_of(freedom),
                       "set reference.model = \"full\"");
    if (properties.moves != std::array<bool, 3>{} && !(c.body.mass > 0))
      complain_about({"body.mass", "body.free"}, "a body that may move along an axis needs body.mass > 0");
    if (!has_inertia(properties))
      complain_about(
          {"body.inertia", "body.free"},
          "body.inertia and body.products are not those of a mass about the axes that may turn",
          "each free axis needs a moment > 0, and a product no larger than the mean of two moments");
    for (int axis = 0; axis < 3; ++axis)
      if (c.motion.rotation[axis] != 0 && !properties.turns[static_cast<std::size_t>(axis)])
        complain_about({"motion.rotation"}, "motion.rotation turns the body about an axis that is held",
                       "name roll, pitch or yaw in body.free");
  }

  void check_gust(const Case& c) {
    const auto& gust = c.gust;
    if (gust.kind == GustKind::none) return;
    const std::string name = "gust.kind = " + toml_string(word_of(gust.kind));
    if (c.motion.kind != MotionKind::none && c.motion.kind != MotionKind::free)
      complain_about({"gust.kind"}, name + " meets a body that is held or flies freely",
                     "set motion.kind = \"none\" or \"free\"");
    if (c.motion.treatment != TreatmentKind::field_velocity)
      complain_about({"motion.treatment"}, "gusts are field velocities", "leave out motion.treatment");
    if (c.motion.kind == MotionKind::none && norm(c.motion.rotation) != 0)
      complain_about({"motion.rotation"}, name + " meets a body that does not turn before",
                     "leave out motion.rotation");
    if (c.reference.half_model && gust.direction == GustDirection::starboard)
      complain_about({"gust.direction"}, "a half model has no gust from the side",
                     "set reference.model = \"full\"");
    if (gust.kind == GustKind::table && gust.table_file.empty())
      complain_about({"gust.kind"}, name + " needs gust.table_file");
    if (c.unsteady.duration <= 0)
      complain_about({"unsteady.duration", "gust.kind"}, name + " needs unsteady.duration > 0");
    if (c.unsteady.steps < 1)
      complain_about({"unsteady.steps", "gust.kind"}, name + " needs unsteady.steps >= 1");
  }

  /// Correlations of boundary layers are of large Reynolds numbers.
  void check_estimates(const Case& c) {
    constexpr Real least = 1e4;
    const auto check = [&](const std::string& key, Real value) {
      if (value != 0 && value < least)
        complain_about({key},
                       fmt::format("{} = {:g} is below {:g}, where no correlation holds", key, value, least),
                       "give that of the flight; 0 leaves it out");
    };
    check("estimates.reynolds", c.estimates.reynolds);
    check("estimates.transition", c.estimates.transition);
  }

  /// A motion that runs to its end must yield derivatives.
  void check_derivatives(const Case& c) {
    const auto& unsteady = c.unsteady;
    const auto refuse = [&](const std::string& key, Real value, Real least, const std::string& why) {
      if (value < least)
        complain_about({"unsteady." + key, "motion.kind"},
                       fmt::format("unsteady.{} = {:g} gives no derivatives: {}", key, value, why),
                       fmt::format("set unsteady.{} = {:g} or more", key, least));
    };
    switch (c.motion.kind) {
      case MotionKind::none:
      case MotionKind::table:
      case MotionKind::free:
        return;
      case MotionKind::step_alpha:
      case MotionKind::step_q:
        return refuse("steps", unsteady.steps, least_step_samples - 1, "too few for the response to a step");
      case MotionKind::ramp_alpha: {
        static_assert(ramp_transient == 0.5);
        return refuse("steps", unsteady.steps, 2 * (least_ramp_samples - 1),
                      "too few are left behind the start of the ramp, which takes half of it");
      }
      default:
        if (unsteady.cycles * unsteady.steps_per_cycle > most_steps)
          complain_about({"unsteady.cycles", "unsteady.steps_per_cycle"},
                         fmt::format("unsteady.cycles * unsteady.steps_per_cycle is {:g} time steps",
                                     unsteady.cycles * unsteady.steps_per_cycle),
                         fmt::format("ask for at most {}", most_steps));
        refuse("cycles", unsteady.cycles, discarded_cycles + least_fitted_cycles,
               fmt::format("the first {:g} are left out as start-up, and the fit takes {:g}",
                           discarded_cycles, least_fitted_cycles));
        refuse("steps_per_cycle", unsteady.steps_per_cycle, steps_per_harmonic * fitted_harmonics + 1,
               fmt::format("the fit goes up to {} times the frequency, with more than {} steps a period",
                           fitted_harmonics, steps_per_harmonic));
    }
  }

  /// Defaults that depend on other keys, and absolute paths.
  void fill_in(Case& c) const {
    std::vector<std::string*> files{&c.mesh.file, &c.mesh.from, &c.motion.table_file, &c.gust.table_file};
    for (auto& file : c.derivatives.coarser_meshes) files.push_back(&file);
    for (auto* file : files)
      if (!file->empty()) *file = fs::absolute(fs::path(path_).parent_path() / *file).lexically_normal();
    if (!entries_.contains("motion.axis_point")) c.motion.axis_point = c.reference.moment_center;
    if (c.output.folder.empty()) c.output.folder = "runs/" + fs::path(path_).stem().string();
  }

  std::vector<Problem> sorted_problems() {
    const auto order = [&](const Problem& p) {
      return std::tuple(p.file != path_, p.file == path_ ? p.line : 0);
    };
    std::ranges::stable_sort(problems_, {}, order);
    if (left_out_ > 0)
      problems_.push_back({path_, 0, fmt::format("and {} more mistakes", left_out_), "is it a case file?"});
    return std::move(problems_);
  }

  std::string path_;
  toml::table file_;
  std::deque<toml::table> overrides_;  ///< entries point into it: elements must not move
  std::map<std::string, Entry> entries_;
  std::vector<Problem> problems_;
  int left_out_ = 0;         ///< problems beyond the first most_problems
  bool unreadable_ = false;  ///< the file is not TOML: what it lacks cannot be told
};

}  // namespace

CaseDraft draft_case(std::string_view text, const std::string& path,
                     const std::vector<std::string>& overrides) {
  CaseReader reader(path);
  reader.add_text(text);
  for (const auto& assignment : overrides) reader.add_override(assignment);
  return reader.finish();
}

Case parse_case(std::string_view text, const std::string& path, const std::vector<std::string>& overrides) {
  auto draft = draft_case(text, path, overrides);
  if (!draft.problems.empty()) throw InputError(std::move(draft.problems));
  return std::move(draft.settings);
}

std::string read_case_text(const std::string& path) {
  return read_file(path, "case file", largest_file);
}

Case read_case(const std::string& path, const std::vector<std::string>& overrides) {
  return parse_case(read_case_text(path), path, overrides);
}

}  // namespace alphadot
