#include "analysis/table.hpp"

#include <fmt/format.h>

#include <algorithm>

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

}  // namespace

std::vector<TableRow> rows_of(const DerivativeSet& derivatives, const std::string& method, Axes axes,
                              std::span<const UncertaintyPart> parts, const std::set<Variable>& unconverged) {
  std::vector<TableRow> rows;
  for (const auto& [variable, values] : derivatives)
    for (int c = 0; c < values.size(); ++c)
      if (values[c].value != 0 || values[c].uncertainty != 0) {
        auto& row = rows.emplace_back(TableRow{
            derivative_name(names_in(axes)[static_cast<std::size_t>(c)], variable), values[c], method, {}});
        row.converged = !unconverged.contains(variable);
        for (const auto& [source, half_width] : parts)
          row.parts.emplace_back(source, half_width.at(variable)[c]);
      }
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
  for (const auto& row : rows) {
    out +=
        fmt::format("{:<{}} {:>13.6g} ± {:<12.2g} ", row.name, width, row.value.value, row.value.uncertainty);
    for (const auto& [source, half_width] : row.parts) out += fmt::format("{:<9.2g} ", half_width);
    out += row.method + (row.converged ? "\n" : "; not converged\n");
  }
  return out;
}

std::string derivative_csv(std::span<const TableRow> rows, const TableHead& head, Axes axes) {
  std::vector<std::string> names{"name", "value", "uncertainty", "method", "converged"};
  const auto sources = sources_of(rows);
  names.insert(names.end(), sources.begin(), sources.end());
  std::string out = csv_comment(head_text(head, axes)) + csv_line(names);
  const auto digits = [](Real number) { return fmt::format("{:.17g}", number); };
  for (const auto& [name, value, method, parts, converged] : rows) {
    std::vector<std::string> cells{name, digits(value.value), digits(value.uncertainty), method,
                                   converged ? "yes" : "no"};
    for (const auto& [source, part] : parts) cells.push_back(digits(part));
    out += csv_line(cells);
  }
  return out;
}

}  // namespace alphadot
