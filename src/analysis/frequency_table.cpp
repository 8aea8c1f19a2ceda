#include "analysis/frequency_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string_view>

#include "core/csv.hpp"

namespace alphadot {

namespace {

constexpr std::string_view whole = "total";

const FrequencyRow* find(std::span<const FrequencyRow> rows, const FrequencyRow& like, Variable variable) {
  const auto found = std::ranges::find_if(rows, [&](const FrequencyRow& row) {
    return row.k == like.k && row.part == like.part && row.coefficient == like.coefficient &&
           row.variable == variable;
  });
  return found == rows.end() ? nullptr : &*found;
}

std::string at(std::string_view name, Real k) {
  return fmt::format("{}, k = {:g}", name, k);
}

}  // namespace

Real FrequencyRow::modulus() const {
  return std::hypot(in_phase.value, k * out_of_phase.value);
}

Real FrequencyRow::phase() const {
  return 180 / std::numbers::pi * std::atan2(k * out_of_phase.value, in_phase.value);
}

std::string frequency_csv(std::span<const FrequencyRow> rows, const TableHead& head) {
  std::string out =
      csv_comment(
          head_text(head) +
          "load = (in_phase + i k out_of_phase) exp(i k t*) of a variable cos(k t*), t* = 2 V t / length; "
          "phase of the load ahead of the variable; of a gust at the moment centre, per w / V\n") +
      "k,part,coefficient,variable,in_phase,in_phase_uncertainty,out_of_phase,out_of_phase_uncertainty,"
      "modulus,"
      "phase_deg,converged\n";
  const auto digits = [](Real number) { return fmt::format("{:.17g}", number); };
  const auto few = [](Real number) { return fmt::format("{:.3g}", number); };
  for (const auto& row : rows)
    out += csv_line(std::vector<std::string>{
        digits(row.k), row.part, row.coefficient, std::string(name(row.variable)), digits(row.in_phase.value),
        few(row.in_phase.uncertainty), digits(row.out_of_phase.value), few(row.out_of_phase.uncertainty),
        digits(row.modulus()), digits(row.phase()), row.converged ? "yes" : "no"});
  return out;
}

std::vector<TableRow> table_rows(std::span<const FrequencyRow> rows) {
  std::vector<TableRow> out;
  const auto add = [&](const FrequencyRow& row, std::string_view variable, const Estimate& value,
                       bool converged) {
    out.push_back({.name = at(fmt::format("{}_{}", row.coefficient, variable), row.k),
                   .value = value,
                   .method = "linear solve in the frequency domain",
                   .converged = converged});
  };
  using enum Variable;
  for (const auto& row : rows) {
    if (row.part != whole) continue;
    const std::string rate = std::string(name(row.variable)) + "dot";
    add(row, name(row.variable), row.in_phase, row.converged);
    add(row, rate, row.out_of_phase, row.converged);
    if (row.variable == q)
      if (const auto* angle = find(rows, row, alpha))
        add(row, name(q_plus_alphadot), row.in_phase + angle->out_of_phase,
            row.converged && angle->converged);
    if (row.variable == r)
      if (const auto* angle = find(rows, row, beta))
        add(row, name(r_minus_betadot), row.in_phase - angle->out_of_phase,
            row.converged && angle->converged);
  }
  return out;
}

}  // namespace alphadot
