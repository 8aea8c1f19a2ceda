#include "analysis/cg_travel.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>

#include "analysis/static_margin.hpp"

namespace alphadot {

namespace {

constexpr std::array titles = {"Cm_alpha", "Cm_q", "Cm_alphadot", "Cm_q+Cm_alphadot", "static margin"};
using Cells = std::array<std::optional<Estimate>, titles.size()>;

Cells cells_of(const DerivativeSet& derivatives) {
  const auto moment = [&](Variable variable) -> std::optional<Estimate> {
    const auto found = derivatives.find(variable);
    if (found == derivatives.end()) return std::nullopt;
    return found->second.Cm;
  };
  const auto q = moment(Variable::q), alphadot = moment(Variable::alphadot);
  auto sum = moment(Variable::q_plus_alphadot);
  if (!sum && q && alphadot) sum = *q + *alphadot;
  std::optional<Estimate> margin;
  if (const auto alpha = derivatives.find(Variable::alpha); alpha != derivatives.end())
    margin = static_margin(alpha->second.CN, alpha->second.Cm);
  return {moment(Variable::alpha), q, alphadot, sum, margin};
}

}  // namespace

std::string cg_travel_table(std::span<const AboutCenter> centers) {
  const auto is_on_axis = [&](const AboutCenter& about) {
    return about.center.y == centers.front().center.y && about.center.z == centers.front().center.z;
  };
  const bool x_alone = std::ranges::all_of(centers, is_on_axis);
  std::string out = fmt::format("{:>10}", "x_cg");
  if (!x_alone) out += fmt::format(" {:>10} {:>10}", "y_cg", "z_cg");
  for (const auto* title : titles) out += fmt::format(" {:>16} {:<10}", title, "  ±");
  out.resize(out.find_last_not_of(' ') + 1);
  out += "\n";
  for (const auto& [center, derivatives] : centers) {
    out += fmt::format("{:>10.6g}", center.x);
    if (!x_alone) out += fmt::format(" {:>10.6g} {:>10.6g}", center.y, center.z);
    for (const auto& cell : cells_of(derivatives))
      out += cell ? fmt::format(" {:>16.6g} ± {:<8.2g}", cell->value, cell->uncertainty)
                  : fmt::format(" {:>16} {:<10}", "-", "");
    out.resize(out.find_last_not_of(' ') + 1);
    out += "\n";
  }
  return out;
}

}  // namespace alphadot
