#include "analysis/derivatives.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <deque>
#include <utility>

namespace alphadot {

namespace {

/// In the order of the enumeration.
constexpr std::array<std::string_view, 13> variable_names = {
    "alpha",           "beta",    "p",         "q",        "r",
    "alphadot",        "betadot", "alphaddot", "betaddot", "q_plus_alphadot",
    "r_minus_betadot", "gust",    "side_gust"};

/// Of the controls that were named so far; names stay where they are.
std::deque<std::string>& control_names() {
  static std::deque<std::string> names;
  return names;
}

constexpr std::string_view rate_suffix = "dot";
/// Numbers of the free stream that adjoints have derivatives by.
constexpr std::array<std::string_view, 2> stream_names = {"mach", "gamma"};

bool is_letter(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
}

}  // namespace

Variable control_variable(std::string_view name) {
  auto& names = control_names();
  const auto at = std::ranges::find(names, name) - names.begin();
  if (at == std::ssize(names)) names.emplace_back(name);
  return static_cast<Variable>(std::ssize(variable_names) + at);
}

bool is_control(Variable variable) {
  return static_cast<std::size_t>(variable) >= variable_names.size();
}

std::string_view name(Variable variable) {
  const auto number = static_cast<std::size_t>(variable);
  return is_control(variable) ? control_names().at(number - variable_names.size()) : variable_names[number];
}

Variable rate_of_control(Variable control) {
  return control_variable(fmt::format("{}{}", name(control), rate_suffix));
}

bool is_control_rate(Variable variable) {
  return is_control(variable) && name(variable).ends_with(rate_suffix);
}

Variable control_of_rate(Variable rate) {
  auto of = name(rate);
  of.remove_suffix(rate_suffix.size());
  return control_variable(of);
}

bool is_control_name(std::string_view name) {
  const auto is_one_of = [&](const auto& names) { return std::ranges::find(names, name) != std::end(names); };
  if (name.empty() || name.ends_with(rate_suffix) || is_one_of(variable_names) || is_one_of(stream_names))
    return false;
  return is_letter(name.front()) &&
         std::ranges::all_of(name, [](char c) { return is_letter(c) || c == '_' || (c >= '0' && c <= '9'); });
}

std::string derivative_name(std::string_view coefficient, Variable variable) {
  return fmt::format("{}_{}", coefficient, name(variable));
}

std::optional<std::pair<int, Variable>> derivative_of_name(std::string_view name, bool may_be_control) {
  const auto bar = name.find('_');
  if (bar == std::string_view::npos) return std::nullopt;
  const auto coefficient = std::ranges::find(coefficient_names, name.substr(0, bar));
  if (coefficient == coefficient_names.end()) return std::nullopt;
  const auto number = static_cast<int>(coefficient - coefficient_names.begin());
  const auto by = name.substr(bar + 1);
  const auto variable = std::ranges::find(variable_names, by);
  if (variable != variable_names.end())
    return std::pair{number, static_cast<Variable>(variable - variable_names.begin())};
  const auto control = by.ends_with(rate_suffix) ? by.substr(0, by.size() - rate_suffix.size()) : by;
  if (may_be_control && is_control_name(control)) return std::pair{number, control_variable(by)};
  return std::nullopt;
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
