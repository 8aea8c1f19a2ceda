#include "derivatives/component_table.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <string_view>
#include <vector>

#include "core/csv.hpp"

namespace alphadot {

namespace {

std::vector<TableRow> rows_of(const EstimatedDerivatives& estimated) {
  return rows_of(estimated.derivatives, "", Axes::body, estimated.parts, estimated.unconverged);
}

const TableRow* find(std::span<const TableRow> rows, std::string_view name) {
  const auto found = std::ranges::find(rows, name, &TableRow::name);
  return found == rows.end() ? nullptr : &*found;
}

void append(std::vector<std::string>& cells, const TableRow* row) {
  cells.push_back(row ? fmt::format("{:.17g}", row->value.value) : "");
  cells.push_back(row ? fmt::format("{:.3g}", row->value.uncertainty) : "");
}

}  // namespace

std::string component_csv(std::span<const ComponentDerivatives> components, const TableHead& head) {
  const bool is_half = head.reference.half_model;
  std::vector<std::string> names{"component", "walls", "name", "value", "uncertainty", "converged"};
  if (is_half) names.insert(names.end(), {"one_side", "one_side_uncertainty"});
  std::string out =
      csv_comment(head_text(head) + (is_half ? "one_side: of the walls of the mesh, y >= 0, alone\n" : "")) +
      csv_line(names);
  for (const auto& component : components) {
    const auto whole = rows_of(component.estimated), one_side = rows_of(component.one_side);
    for (const auto& row : is_half ? one_side : whole) {
      std::vector<std::string> cells{component.name, fmt::format("{}", fmt::join(component.walls, " ")),
                                     row.name};
      append(cells, find(whole, row.name));
      cells.emplace_back(row.converged ? "yes" : "no");
      if (is_half) append(cells, &row);
      out += csv_line(cells);
    }
  }
  return out;
}

}  // namespace alphadot
