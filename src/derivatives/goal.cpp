#include "derivatives/goal.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <vector>

#include "core/error.hpp"
#include "derivatives/flight_variables.hpp"

namespace alphadot {

Goal parse_goal(std::string_view text, const std::string& where, const FlightCondition& flight,
                const Components& components) {
  const std::size_t at = std::min(text.find('@'), text.size());
  const auto found = derivative_of_name(text.substr(0, at));
  if (!found)
    throw InputError(where, 0, fmt::format("there is no derivative \"{}\"", text),
                     "name derivatives of loads, such as Cm_alpha, Cm_q or Cm_alphadot, with @patch or "
                     "@patch+patch for some of the walls");
  const auto [coefficient, variable] = *found;
  const Functional load{coefficient, {}, rates_in(variable)};
  Goal goal{parse_functional(load.name() + std::string(text.substr(at)), where, flight, components),
            variable};
  const auto known = variables_of(goal.functional, flight);
  if (std::ranges::find(known, variable) == known.end()) {
    std::vector<std::string_view> names;
    for (const Variable one : known) names.push_back(name(one));
    throw InputError(where, 0, fmt::format("{} is no derivative of this case", text),
                     fmt::format("differentiate by {}", fmt::join(names, ", ")));
  }
  return goal;
}

namespace {

/// The angle, its rate and its second rate, as far as a variable goes; a rotation alone.
std::vector<Variable> links_of(Variable variable) {
  using enum Variable;
  std::vector<Variable> out{angle_of(variable)};
  if (rates_in(variable) >= 1) out.push_back(out[0] == alpha ? alphadot : betadot);
  if (rates_in(variable) == 2) out.push_back(variable);
  return out;
}

}  // namespace

DerivativeChain chain_of(const Goal& goal, const FlowCase& flow, const Adjoints& adjoints,
                         const Responses& responses) {
  DerivativeChain out{
      .name = goal.name(),
      .weights = weights_of(goal.functional, flow.setup().domain.patch_names, flow.settings()),
      .change = change_of(angle_of(goal.variable), flow.settings().freestream)};
  for (const Variable link : links_of(goal.variable)) out.responses.emplace_back(responses.at({link}).field);
  for (int rates = 0; rates <= goal.functional.rates; ++rates)
    out.adjoints.emplace_back(
        adjoints.at(Functional{goal.functional.coefficient, goal.functional.patches, rates}.name()).field);
  return out;
}

}  // namespace alphadot
