#include "analysis/derivatives.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

namespace alphadot {

namespace {

/// In the order of the enumeration.
constexpr std::array<std::string_view, 11> variable_names = {
    "alpha",           "beta",           "p", "q", "r", "alphadot", "betadot", "alphaddot", "betaddot",
    "q_plus_alphadot", "r_minus_betadot"};

}  // namespace

std::string_view name(Variable variable) {
  return variable_names[static_cast<std::size_t>(variable)];
}

std::string derivative_name(std::string_view coefficient, Variable variable) {
  return fmt::format("{}_{}", coefficient, name(variable));
}

std::optional<std::pair<int, Variable>> derivative_of_name(std::string_view name) {
  const auto bar = name.find('_');
  if (bar == std::string_view::npos) return std::nullopt;
  const auto coefficient = std::ranges::find(coefficient_names, name.substr(0, bar));
  const auto variable = std::ranges::find(variable_names, name.substr(bar + 1));
  if (coefficient == coefficient_names.end() || variable == variable_names.end()) return std::nullopt;
  return std::pair{static_cast<int>(coefficient - coefficient_names.begin()),
                   static_cast<Variable>(variable - variable_names.begin())};
}

void EstimatedDerivatives::add(std::string source, DerivativeSetOf<Real> half_width) {
  for (auto& [variable, column] : derivatives)
    for (int i = 0; i < column.size(); ++i) column[i].uncertainty += half_width.at(variable)[i];
  parts.push_back({std::move(source), std::move(half_width)});
}

Real quasi_steady_limit(Real by_angle, Real by_second_rate, Real share) {
  return std::sqrt(share * std::abs(by_angle / by_second_rate));
}

}  // namespace alphadot
