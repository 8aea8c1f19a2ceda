#include "derivatives/panel_table.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "core/csv.hpp"
#include "derivatives/loads.hpp"
#include "derivatives/part.hpp"

namespace alphadot {

namespace {

using NamedNumbers = std::vector<std::pair<std::string, Estimate>>;

/// Three loads and where the normal force acts, where that is known.
NamedNumbers named(const PanelLoads<Estimate>& loads, const ReferenceSettings& reference,
                   std::string_view by) {
  const auto name = [&](std::string_view what) {
    return by.empty() ? std::string(what) : fmt::format("{}_{}", what, by);
  };
  NamedNumbers out;
  for (std::size_t i = 0; i < panel_load_names.size(); ++i)
    out.emplace_back(name(panel_load_names[i]), loads[i]);
  const Estimate& normal = loads.normal;
  if (!(std::abs(normal.value) > normal.uncertainty)) return out;
  const auto at = [&](const Estimate& moment, Real sign) {
    const Real place = moment.value / normal.value;
    return Estimate{sign * reference.length * place,
                    reference.length * (moment.uncertainty + std::abs(place) * normal.uncertainty) /
                        (std::abs(normal.value) - normal.uncertainty)};
  };
  out.emplace_back(name("x_cp"), at(loads.hinge, -1));
  out.emplace_back(name("s_cp"), at(loads.bending, 1));
  return out;
}

CoefficientsOf<Estimate> exact(const Coefficients& values) {
  CoefficientsOf<Estimate> out;
  for (int i = 0; i < out.size(); ++i) out[i].value = values[i];
  return out;
}

}  // namespace

std::map<std::string, std::vector<std::pair<std::string, Real>>> steady_panel_loads(
    const FlightCondition& settings, std::span<const ControlSettings> controls, std::span<const Load> loads,
    std::span<const std::string> patch_names) {
  std::map<std::string, std::vector<std::pair<std::string, Real>>> out;
  for (const auto& control : controls) {
    const Load load = Part(control.patches, patch_names).of(loads, {});
    const auto of_panel =
        panel_loads(exact(coefficients(load, of_one_side(settings))), frame_of(control), settings.reference);
    for (const auto& [name, estimate] : named(of_panel, settings.reference, ""))
      out[control.name].emplace_back(name, estimate.value);
  }
  return out;
}

std::string panel_csv(std::span<const PanelDerivatives> panels,
                      const std::map<std::string, std::vector<std::pair<std::string, Real>>>& steady,
                      const TableHead& head) {
  std::string out =
      csv_comment(head_text(head) +
                  "Panels of controls, each by itself, by the same reference area and length\n" +
                  std::string(panel_note) +
                  "\nx_cp, s_cp: where CNp acts, aft of the hinge line and outboard of the hinge's point\n") +
      csv_line(std::array<std::string, 5>{"panel", "name", "value", "uncertainty", "converged"});
  const auto line = [&](const std::string& panel, const std::string& name, const Estimate& value,
                        const std::string& uncertainty, bool converged) {
    out += csv_line(std::array<std::string, 5>{panel, name, fmt::format("{:.17g}", value.value), uncertainty,
                                               converged ? "yes" : "no"});
  };
  for (const auto& [control, frame, estimated] : panels) {
    for (const auto& [name, value] : steady.at(control)) line(control, name, {value, 0}, "", true);
    for (const auto& [variable, column] : estimated.derivatives)
      for (const auto& [name, estimate] :
           named(panel_loads(column, frame, head.reference), head.reference, alphadot::name(variable)))
        line(control, name, estimate, fmt::format("{:.3g}", estimate.uncertainty),
             !estimated.unconverged.contains(variable));
  }
  return out;
}

}  // namespace alphadot
