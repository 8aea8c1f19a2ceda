#include "analysis/paper_table.hpp"

#include <fmt/format.h>

#include <cmath>

namespace alphadot {

namespace {

/// One of the three tables: a derivative of Cm and where the paper lists it.
struct Quantity {
  Variable variable;
  Real PaperRow::*paper;
  bool relative;       ///< difference in per cent
  const char* remark;  ///< behind the table's title
};

constexpr Quantity quantities[] = {
    {Variable::alpha, &PaperRow::static_field, true, "static; the fitted centre was chosen to match these"},
    {Variable::alphadot, &PaperRow::acceleration_field, false, "acceleration; a prediction"},
    {Variable::q, &PaperRow::damping_field, true, "damping; a prediction"},
};

const ComputedPoint* point_at(std::span<const ComputedPoint> points, Real mach) {
  for (const auto& point : points)
    if (std::abs(point.mach - mach) < 1e-6) return &point;
  return nullptr;
}

std::string line(const PaperRow& row, const Quantity& quantity, const ComputedPoint& point, Real dx) {
  const auto found = point.derivatives.find(quantity.variable);
  const Real paper = row.*quantity.paper;
  if (found == point.derivatives.end()) return fmt::format("| {:.2f} | | | {:.4f} | |", row.mach, paper);
  const Estimate own = found->second.Cm;
  const Estimate moved = moment_transfer(point.derivatives, dx).at(quantity.variable).Cm;
  return fmt::format("| {:.2f} | {:.3f} ± {:.2g} | {:.3f} ± {:.2g} | {:.4f} | {} |", row.mach, own.value,
                     own.uncertainty, moved.value, moved.uncertainty, paper,
                     quantity.relative ? fmt::format("{:+.1f} %", 100 * (moved.value / paper - 1))
                                       : fmt::format("{:+.2f}", moved.value - paper));
}

}  // namespace

std::string paper_comparison(std::span<const ComputedPoint> points, Real x_center, Real x_fitted) {
  std::string out;
  for (const auto& quantity : quantities) {
    const bool is_static = quantity.variable == Variable::alpha;
    out += fmt::format(
        "\nCm_{} ({})\n\n| Mach | about {:g} | about {:.3f} (fitted) | paper | difference |{}\n",
        name(quantity.variable), quantity.remark, x_center, x_fitted, is_static ? " experiment |" : "");
    out += fmt::format("|---|---|---|---|---|{}\n", is_static ? "---|" : "");
    for (const auto& row : paper_table_one)
      if (const auto* point = point_at(points, row.mach))
        out += line(row, quantity, *point, x_fitted - x_center) +
               (is_static ? fmt::format(" {:.4f} |", row.static_experiment) : "") + "\n";
  }
  return out;
}

}  // namespace alphadot
