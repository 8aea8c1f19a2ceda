// Derivatives of panels, in their own frames, as text.
#pragma once

#include <map>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "analysis/table.hpp"
#include "derivatives/linear_derivatives.hpp"

namespace alphadot {

/// What the names of loads of panels mean.
inline constexpr std::string_view panel_note =
    "CNp: force across hinge and x axis, positive as of a positive deflection; Ch: moment about the hinge, "
    "positive as it turns by a positive deflection; Cb: moment about the line along x through the hinge's "
    "point";

/// The loads of the panels of all controls, and where they act: names and values, by the control. Without the
/// mirror image of a half model.
std::map<std::string, std::vector<std::pair<std::string, Real>>> steady_panel_loads(
    const FlightCondition& settings, std::span<const ControlSettings> controls, std::span<const Load> loads,
    std::span<const std::string> patch_names);

/// Comment lines with the head and what the names mean, a header, a line for each panel and quantity: of the
/// steady flow, then of every derivative.
std::string panel_csv(std::span<const PanelDerivatives> panels,
                      const std::map<std::string, std::vector<std::pair<std::string, Real>>>& steady,
                      const TableHead& head);

}  // namespace alphadot
