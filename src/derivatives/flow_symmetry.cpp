#include "derivatives/flow_symmetry.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "derivatives/loads.hpp"

namespace alphadot {

namespace {

using enum Variable;

constexpr Real nothing = 1e-6;

// What the mirrors turn round.
constexpr std::array<std::string_view, 3> loads_up{"CN", "Cl", "Cm"}, loads_aside{"CY", "Cl", "Cn"};
constexpr std::array variables_up{alpha, q, p, alphadot, alphaddot, gust},
    variables_aside{beta, r, p, betadot, betaddot, side_gust};

bool is_one_of(const auto& all, const auto& one) {
  return std::ranges::find(all, one) != all.end();
}

}  // namespace

FlowSymmetry::FlowSymmetry(const Coefficients& loads, const Configuration& configuration, bool half_model) {
  const Real force = nothing * configuration.wall_area, moment = force * configuration.body_length;
  is_level_ = std::abs(loads.CN) <= force && std::abs(loads.Cl) <= moment && std::abs(loads.Cm) <= moment;
  is_upright_ = !half_model && std::abs(loads.CY) <= force && std::abs(loads.Cl) <= moment &&
                std::abs(loads.Cn) <= moment;
}

bool FlowSymmetry::makes_zero(int coefficient, Variable variable) const {
  if (is_control(variable)) return false;
  const auto load = coefficient_names[static_cast<std::size_t>(coefficient)];
  return (is_level_ && is_one_of(loads_up, load) != is_one_of(variables_up, variable)) ||
         (is_upright_ && is_one_of(loads_aside, load) != is_one_of(variables_aside, variable));
}

FlowSymmetry symmetry_of(const Part& part, const FlowCase& flow, const FlightCondition& settings) {
  const auto& report = flow.steady_report();
  return {coefficients(part.of(report.loads, report.total), settings), flow.setup().configuration,
          settings.reference.half_model};
}

}  // namespace alphadot
