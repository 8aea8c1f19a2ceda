#include "io/history.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <set>
#include <sstream>
#include <stdexcept>

#include "core/csv.hpp"
#include "core/error.hpp"
#include "io/files.hpp"
#include "io/provenance.hpp"

namespace alphadot {
namespace {

constexpr char format_name[] = "alphadot history";
constexpr std::int64_t format_version = 2;

std::vector<double> as_vector(const Vec3& v) {
  return {v.x, v.y, v.z};
}

Vec3 read_point(const hdf5::Group& group, const std::string& name) {
  const auto v = group.attributes<double>(name);
  if (v.size() != 3) throw InputError(group.file(), 0, "attribute " + name + " must hold three values");
  return {v[0], v[1], v[2]};
}

template <class E>
E read_word(const hdf5::Group& group, const std::string& name) {
  const auto text = group.text_attribute(name);
  const auto value = named_by<E>(text);
  if (!value)
    throw InputError(group.file(), 0, "attribute " + name + " has the unknown value \"" + text + "\"");
  return *value;
}

void write_info(hdf5::Group& group, const HistoryInfo& info) {
  group.set_attribute("title", info.title);
  group.set_attribute("reference_length", info.reference.length);
  group.set_attribute("reference_area", info.reference.area);
  group.set_attribute("moment_center", as_vector(info.reference.moment_center));
  group.set_attribute("half_model", std::int32_t{info.reference.half_model});
  group.set_attribute("mach", info.freestream.mach);
  group.set_attribute("alpha", info.freestream.alpha);
  group.set_attribute("beta", info.freestream.beta);
  group.set_attribute("gamma", info.freestream.gamma);
  group.set_attribute("motion", word_of(info.motion.kind));
  group.set_attribute("treatment", word_of(info.motion.treatment));
  group.set_attribute("amplitude", info.motion.amplitude);
  group.set_attribute("reduced_frequency", info.motion.reduced_frequency);
  group.set_attribute("axis_point", as_vector(info.motion.axis_point));
  group.set_attribute("motion_table", info.motion.table_file);
  group.set_attribute("motion_table_hash", info.motion_table_hash);
  group.set_attribute("mesh_file", info.mesh_file);
  group.set_attribute("mesh_hash", info.mesh_hash);
  group.set_attribute("version", info.version);
  group.set_attribute("conventions", info.conventions);
  group.set_attribute("status", info.status);
  group.write_text("case", info.case_text);
}

HistoryInfo read_info(const hdf5::Group& group) {
  HistoryInfo info;
  info.title = group.text_attribute("title");
  info.reference = {.length = group.attribute<double>("reference_length"),
                    .area = group.attribute<double>("reference_area"),
                    .moment_center = read_point(group, "moment_center"),
                    .half_model = group.attribute<std::int32_t>("half_model") != 0};
  info.freestream = {.mach = group.attribute<double>("mach"),
                     .alpha = group.attribute<double>("alpha"),
                     .beta = group.attribute<double>("beta"),
                     .gamma = group.attribute<double>("gamma")};
  info.motion = {.kind = read_word<MotionKind>(group, "motion"),
                 .treatment = read_word<TreatmentKind>(group, "treatment"),
                 .amplitude = group.attribute<double>("amplitude"),
                 .reduced_frequency = group.attribute<double>("reduced_frequency"),
                 .axis_point = read_point(group, "axis_point"),
                 .table_file = group.text_attribute("motion_table")};
  if (group.has_attribute("motion_table_hash"))
    info.motion_table_hash = group.text_attribute("motion_table_hash");
  if (group.has_attribute("mesh_file")) info.mesh_file = group.text_attribute("mesh_file");
  info.mesh_hash = group.text_attribute("mesh_hash");
  info.version = group.text_attribute("version");
  info.conventions = group.text_attribute("conventions");
  if (group.has_attribute("status")) info.status = group.text_attribute("status");
  info.case_text = group.dataset("case").read_text();
  return info;
}

void check_format(const hdf5::Group& group) {
  if (!group.has_attribute("format") || group.text_attribute("format") != format_name)
    throw InputError(group.file(), 0, "not a history of alphadot", "give the history.h5 of a run");
  const auto version = group.attribute<std::int64_t>("format_version");
  if (version != format_version)
    throw InputError(group.file(), 0,
                     fmt::format("a history of format {}, this program reads {}", version, format_version));
}

}  // namespace

void History::append(const Row& row) {
  if (names_.empty()) {
    std::set<std::string> seen;
    for (const auto& [name, value] : row) {
      if (!seen.insert(name).second) throw InputError("", 0, "the history has two columns " + name);
      names_.push_back(name);
    }
    columns_.resize(row.size());
  }
  const auto name_of = [](const auto& entry) -> const std::string& { return entry.first; };
  if (!std::ranges::equal(row, names_, {}, name_of))
    throw std::logic_error("a history row with other columns");
  for (std::size_t i = 0; i < row.size(); ++i) columns_[i].push_back(row[i].second);
}

bool History::has(const std::string& name) const {
  return std::ranges::find(names_, name) != names_.end();
}

const std::vector<Real>& History::column(const std::string& name) const {
  const auto found = std::ranges::find(names_, name);
  if (found != names_.end()) return columns_[static_cast<std::size_t>(found - names_.begin())];
  std::string all;
  for (const auto& known : names_) all += (all.empty() ? "" : ", ") + known;
  throw InputError("", 0, "the history has no column " + name, "it has " + all);
}

std::vector<std::string> History::components() const {
  std::vector<std::string> found;
  for (const auto& name : names_)
    if (name.ends_with("/CA")) found.push_back(name.substr(0, name.size() - 3));
  return found;
}

void History::write(hdf5::Group& group) const {
  group.set_attribute("format", format_name);
  group.set_attribute("format_version", format_version);
  write_info(group, info);
  std::string lines;
  for (const auto& name : names_) lines += name + "\n";
  group.write_text("column_names", lines);
  const auto columns = group.create_group("columns");
  for (std::size_t i = 0; i < names_.size(); ++i) columns.write(names_[i], columns_[i]);
}

History History::read(const hdf5::Group& group) {
  check_format(group);
  History history(read_info(group));
  std::istringstream lines(group.dataset("column_names").read_text());
  const auto columns = group.group("columns");
  for (std::string name; std::getline(lines, name);) {
    if (history.has(name)) throw InputError(group.file(), 0, "two columns " + name);
    auto values = columns.dataset(name).read<double>();
    if (!history.columns_.empty() && values.size() != history.steps())
      throw InputError(
          group.file(), 0,
          fmt::format("column {} has {} steps, others have {}", name, values.size(), history.steps()));
    history.names_.push_back(name);
    history.columns_.push_back(std::move(values));
  }
  return history;
}

std::string History::csv() const {
  std::string text;
  if (names_.empty()) return text;
  text += csv_comment("Flow: " + info.origin().text());
  if (!info.status.empty()) text += csv_comment("Status: " + info.status);
  text += csv_line(names_);
  for (std::size_t step = 0; step < steps(); ++step) text += csv_row(step);
  return text;
}

std::string History::csv_row(std::size_t step) const {
  std::vector<std::string> cells;
  for (const auto& column : columns_) cells.push_back(fmt::format("{}", column[step]));
  return csv_line(cells);
}

bool is_reserved_component(const std::string& name) {
  constexpr std::string_view names[] = {
      "step", "time", "t_star",           "alpha", "beta",  "phi",          "theta",      "psi", "p",
      "q",    "r",    "inner_iterations", "total", "error", "inner_orders", "inner_left", ".",   ".."};
  return std::ranges::find(names, name) != std::end(names);
}

void write_history(const std::string& folder, const History& history) {
  const std::filesystem::path in(folder);
  replace_file(in / "history.h5", [&](const std::string& temporary) {
    auto file = hdf5::File::create(temporary);
    history.write(file);
    file.close();
  });
  replace_file_with(in / "history.csv", history.csv());
}

History read_history(const std::string& path) {
  return History::read(hdf5::File::open(path));
}

}  // namespace alphadot
