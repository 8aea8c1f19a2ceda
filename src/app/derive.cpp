// The verb "derive": derivatives of finished runs about any centre.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <nlohmann/json.hpp>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "analysis/cg_travel.hpp"
#include "analysis/moment_transfer.hpp"
#include "analysis/table.hpp"
#include "app/centers.hpp"
#include "app/derived_file.hpp"
#include "app/verbs.hpp"
#include "core/error.hpp"
#include "core/log.hpp"

namespace alphadot {

namespace {

/// A file's derivatives about another centre, and those that could not be moved there.
struct Moved {
  DerivedFile about;
  std::vector<TableRow> rows;
  std::vector<std::string_view> left_out;
};

Moved moved_to(const Vec3& center, DerivedFile from) {
  auto& reference = from.reference;
  const Vec3 offset = 1 / reference.length * (center - reference.moment_center);
  EstimatedDerivatives moved;
  try {
    moved = moment_transfer(from.estimated, offset);
  } catch (const InputError& error) {
    const auto& problem = error.problems().front();
    throw InputError(from.file, 0, problem.what, problem.remedy);
  }
  std::vector<std::string_view> left_out;
  for (const auto& [variable, column] : from.estimated.derivatives)
    if (!moved.derivatives.contains(variable)) left_out.push_back(name(variable));
  from.estimated = std::move(moved);
  for (auto& loads : from.loads) loads = moment_transfer(loads, offset);
  reference.moment_center = center;
  auto rows = rows_of(from.estimated.derivatives, from.method, Axes::body, from.estimated.parts,
                      from.estimated.unconverged);
  return {std::move(from), std::move(rows), std::move(left_out)};
}

/// About every centre asked for, or that of the file.
std::vector<Moved> about_all(const DerivedFile& from, std::span<const Center> centers) {
  const Vec3& own = from.reference.moment_center;
  if (centers.empty()) return {moved_to(own, from)};
  std::vector<Moved> out;
  for (const auto& center : centers) out.push_back(moved_to(center.of(own), from));
  return out;
}

std::string status_text(const DerivedFile& about) {
  return about.status + (about.message.empty() ? "" : ": ") + about.message;
}

void print_tables(std::span<const Moved> moved) {
  for (const auto& [about, rows, left_out] : moved)
    fmt::print("File: {}\n{}\n", about.file,
               derivative_table(rows, {about.reference, status_text(about), uncertainty_scope(rows),
                                       about.origin.text()}));
  if (moved.size() < 2) return;
  std::vector<AboutCenter> centers;
  for (const auto& [about, rows, left_out] : moved)
    centers.push_back({about.reference.moment_center, about.estimated.derivatives});
  const auto& first = moved.front();
  const std::string status = status_text(first.about);
  fmt::print("Centre of gravity: {}{}{}; ± {}; per rad, static margin in lengths\n{}\n", first.about.file,
             status.empty() ? "" : "; ", status, uncertainty_scope(first.rows), cg_travel_table(centers));
}

using Json = nlohmann::ordered_json;

Json json_of(const Moved& moved) {
  const auto& [about, rows, left_out] = moved;
  const auto& reference = about.reference;
  const auto& stream = about.origin.freestream;
  Json derivatives = Json::object();
  for (const auto& row : rows) {
    Json& entry = derivatives[row.name] = {{"value", row.value.value},
                                           {"uncertainty", row.value.uncertainty},
                                           {"method", row.method},
                                           {"converged", row.converged}};
    for (const auto& [source, half_width] : row.parts) entry["parts"][source] = half_width;
  }
  Json loads = Json::object();
  for (int i = 0; i < Coefficients::size(); ++i) {
    Json& column = loads[std::string(coefficient_names[static_cast<std::size_t>(i)])] = Json::array();
    for (const auto& at : about.loads) column.push_back(at[i]);
  }
  const Vec3& center = reference.moment_center;
  return {{"file", about.file},
          {"status", about.status},
          {"message", about.message},
          {"center", {center.x, center.y, center.z}},
          {"reference",
           {{"length", reference.length},
            {"area", reference.area},
            {"model", reference.half_model ? "half" : "full"}}},
          {"freestream",
           {{"mach", stream.mach}, {"alpha", stream.alpha}, {"beta", stream.beta}, {"gamma", stream.gamma}}},
          {"loads", loads},
          {"uncertainty", uncertainty_scope(rows)},
          {"left_out", left_out},
          {"derivatives", derivatives}};
}

void print_json(std::span<const std::vector<Moved>> files) {
  Json list = Json::array();
  for (const auto& moved : files)
    for (const auto& about : moved) list.push_back(json_of(about));
  // Shortest digits that give each number back; the replacement character for what is not UTF-8.
  fmt::print("{}\n", list.dump(2, ' ', false, Json::error_handler_t::replace));
}

void say_what_is_left_out(std::span<const std::vector<Moved>> files) {
  std::set<std::string_view> variables;
  for (const auto& moved : files)
    for (const auto& about : moved) variables.insert(about.left_out.begin(), about.left_out.end());
  if (!variables.empty())
    spdlog::warn(
        "left out about centres off a run's own axis: derivatives by {}; they need those by speed, which are "
        "not known",
        fmt::join(variables, ", "));
}

}  // namespace

RunStatus derive_verb(const DeriveArguments& arguments, const Communicator& comm) {
  comm.on_root([&] {
    std::vector<Center> centers;
    for (const auto& text : arguments.centers) centers.push_back(parse_center(text));
    if (!arguments.centers_file.empty())
      for (const auto& center : read_centers(arguments.centers_file)) centers.push_back(center);

    std::vector<std::vector<Moved>> files;
    for (const auto& file : arguments.files) files.push_back(about_all(read_derivatives(file), centers));
    if (arguments.as_json)
      print_json(files);
    else
      for (const auto& moved : files) print_tables(moved);
    say_what_is_left_out(files);
  });
  return RunStatus::completed;
}

}  // namespace alphadot
