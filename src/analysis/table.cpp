#include "analysis/table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "core/csv.hpp"

namespace alphadot {

namespace {

/// Of the parts of the uncertainty.
std::vector<std::string> sources_of(std::span<const TableRow> rows) {
  std::vector<std::string> out;
  if (!rows.empty())
    for (const auto& [source, half_width] : rows.front().parts) out.push_back(source);
  return out;
}

constexpr std::array<std::string_view, 5> group_words = {"longitudinal", "lateral", "cross", "controls", ""};

std::string_view word_of(Group group) {
  return group_words[static_cast<std::size_t>(group)];
}

bool is_lateral(Variable variable) {
  switch (variable) {
    case Variable::beta:
    case Variable::p:
    case Variable::r:
    case Variable::betadot:
    case Variable::betaddot:
    case Variable::r_minus_betadot:
      return true;
    default:
      return false;
  }
}

/// Which rows are zero within their uncertainty, in lines that fit a page; empty without any.
std::string zeros_text(std::span<const TableRow> rows) {
  constexpr std::size_t width = 120;
  std::string out, line = "Zero within their ±:";
  std::size_t count = 0;
  for (const auto& row : rows) {
    if (!row.is_zero()) continue;
    if (line.size() + row.name.size() >= width) {
      out += line + "\n";
      line = " ";
    }
    line += " " + row.name;
    ++count;
  }
  return count ? out + line + "\n" : "";
}

std::string line_of(const TableRow& row, std::size_t width) {
  std::string out =
      fmt::format("{:<{}} {:>13.6g} ± {:<12.2g} ", row.name, width, row.value.value, row.value.uncertainty);
  for (const auto& [source, half_width] : row.parts) out += fmt::format("{:<9.2g} ", half_width);
  return out + row.method + (row.converged ? "\n" : "; not converged\n");
}

}  // namespace

Group group_of(int coefficient, Variable variable) {
  if (is_control(variable)) return Group::controls;
  const bool out_of_plane = coefficient % 2 == 1;  // CY, Cl, Cn
  if (out_of_plane != is_lateral(variable)) return Group::cross;
  return out_of_plane ? Group::lateral : Group::longitudinal;
}

bool TableRow::is_zero() const {
  const auto is_by_symmetry = [](const auto& part) { return part.first == symmetry_part && part.second > 0; };
  const bool may_be =
      group == Group::cross || group == Group::controls || std::ranges::any_of(parts, is_by_symmetry);
  return may_be && std::isfinite(value.uncertainty) && std::abs(value.value) <= value.uncertainty;
}

std::vector<TableRow> rows_of(const DerivativeSet& derivatives, const std::string& method, Axes axes,
                              std::span<const UncertaintyPart> parts, const std::set<Variable>& unconverged) {
  std::vector<TableRow> rows;
  for (const auto& [variable, values] : derivatives)
    for (int c = 0; c < values.size(); ++c)
      if (values[c].value != 0 || values[c].uncertainty != 0) {
        auto& row = rows.emplace_back(TableRow{
            derivative_name(names_in(axes)[static_cast<std::size_t>(c)], variable), values[c], method, {}});
        row.converged = !unconverged.contains(variable);
        row.group = group_of(c, variable);
        for (const auto& [source, half_width] : parts)
          row.parts.emplace_back(source, half_width.at(variable)[c]);
      }
  std::ranges::stable_sort(rows, {}, &TableRow::group);
  return rows;
}

std::string uncertainty_scope(std::span<const TableRow> rows) {
  const auto has_mesh = [](const TableRow& row) {
    return std::ranges::any_of(row.parts, [](const auto& part) { return part.first == "mesh"; });
  };
  return std::string(!rows.empty() && std::ranges::all_of(rows, has_mesh) ? "solver and mesh" : solver_only);
}

std::string head_text(const TableHead& head, Axes axes) {
  const auto& reference = head.reference;
  const Vec3& center = reference.moment_center;
  const char* axes_text =
      axes == Axes::body
          ? "body: CA aft, CY starboard, CN up; Cl, Cm, Cn about x forward, y starboard, z down"
          : "stability: CD and CL along and across the projected wind; Cl, Cn about axes turned "
            "with alpha; Cm nose up";
  std::string out = fmt::format(
      "Reference: length {:g}, area {:g}, moment centre and axis of rotation ({:g}, {:g}, {:g})\n"
      "Axes: {}\n"
      "Units: per rad; rates times length / 2V\n",
      reference.length, reference.area, center.x, center.y, center.z, axes_text);
  if (!head.origin.empty()) out += "Flow: " + head.origin + "\n";
  if (!head.status.empty()) out += "Status: " + head.status + "\n";
  if (!head.uncertainty.empty()) out += "Uncertainty: " + head.uncertainty + "\n";
  return out;
}

std::string derivative_table(std::span<const TableRow> rows, const TableHead& head, Axes axes) {
  std::size_t width = 4;
  for (const auto& row : rows) width = std::max(width, row.name.size());
  std::string out = head_text(head, axes);
  out += fmt::format("{:<{}} {:>13}   {:<12} ", "name", width, "value",
                     head.uncertainty == solver_only ? "solver only" : "uncertainty");
  for (const auto& source : sources_of(rows)) out += fmt::format("{:<9} ", source);
  out += "method\n";
  const auto is_alone = [&](const TableRow& row) { return row.group == rows.front().group; };
  const bool one_group = std::ranges::all_of(rows, is_alone);
  for (const auto group :
       {Group::longitudinal, Group::lateral, Group::cross, Group::controls, Group::other}) {
    std::string lines;
    for (const auto& row : rows)
      if (row.group == group && !row.is_zero()) lines += line_of(row, width);
    if (!one_group && !lines.empty() && group != Group::other) out += fmt::format("  {}\n", word_of(group));
    out += lines;
  }
  return out + zeros_text(rows);
}

std::string derivative_csv(std::span<const TableRow> rows, const TableHead& head, Axes axes) {
  std::vector<std::string> names{"name", "value", "uncertainty", "method", "converged", "group"};
  const auto sources = sources_of(rows);
  names.insert(names.end(), sources.begin(), sources.end());
  std::string out = csv_comment(head_text(head, axes) + zeros_text(rows)) + csv_line(names);
  const auto digits = [](Real number) { return fmt::format("{:.17g}", number); };
  for (const auto& row : rows) {
    std::vector<std::string> cells{row.name,   digits(row.value.value),      digits(row.value.uncertainty),
                                   row.method, row.converged ? "yes" : "no", std::string(word_of(row.group))};
    for (const auto& [source, part] : row.parts) cells.push_back(digits(part));
    out += csv_line(cells);
  }
  return out;
}

}  // namespace alphadot
