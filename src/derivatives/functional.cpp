#include "derivatives/functional.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "core/error.hpp"
#include "derivatives/flight_variables.hpp"
#include "derivatives/loads.hpp"

namespace alphadot {

namespace {

constexpr std::array<std::string_view, 3> suffixes = {"", "_alphadot", "_alphaddot"};

std::string at_patches(const Functional& functional) {
  return functional.patches.empty() ? "" : fmt::format("@{}", fmt::join(functional.patches, "+"));
}

std::vector<std::string> split(std::string_view text, char at) {
  std::vector<std::string> out;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(at, begin), text.size());
    out.emplace_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  return out;
}

Real product(const Vec3& a, const Vec3& b, bool of_magnitudes) {
  Real sum = 0;
  for (int i = 0; i < 3; ++i)
    if (b[i] != 0)
      sum += of_magnitudes ? std::abs(a[i] * b[i]) : a[i] * b[i];  // nothing of what is not known
  return sum;
}

Real product(const ConditionsChange& a, const ConditionsChange& b, bool of_magnitudes = false) {
  return product(a.wind, b.wind, of_magnitudes) + product(a.grid_velocity, b.grid_velocity, of_magnitudes) +
         product(a.rotation, b.rotation, of_magnitudes);
}

}  // namespace

std::string Functional::name() const {
  return fmt::format("{}{}{}", coefficient_names[static_cast<std::size_t>(coefficient)],
                     suffixes[static_cast<std::size_t>(rates)], at_patches(*this));
}

bool vanishes(int coefficient, const FlightCondition& settings) {
  const Load weight = coefficient_weight(coefficient, settings);
  return norm(weight.force) + norm(weight.moment) == 0;
}

Functional parse_functional(std::string_view name, const std::string& where, const FlightCondition& settings,
                            const Components& components) {
  Functional out;
  const std::size_t at = std::min(name.find('@'), name.size()), end_of_coefficient = name.find('_');
  const auto coefficient = name.substr(0, std::min(at, end_of_coefficient));
  const auto suffix = name.substr(coefficient.size(), at - coefficient.size());
  const auto found = std::ranges::find(coefficient_names, coefficient);
  const auto rates = std::ranges::find(suffixes, suffix);
  if (found == coefficient_names.end() || rates == suffixes.end())
    throw InputError(
        where, 0, fmt::format("there is no load \"{}\"", name),
        fmt::format("name any of {}, with _alphadot for its response to the rates of the angles, "
                    "with @wall or @wall+set for some of the walls",
                    fmt::join(coefficient_names, ", ")));
  out.coefficient = static_cast<int>(found - coefficient_names.begin());
  out.rates = static_cast<int>(rates - suffixes.begin());
  if (at < name.size())
    for (const auto& component : split(name.substr(at + 1), '+')) {
      const auto walls = components.find(component);
      if (walls == components.end())
        throw InputError(where, 0,
                         fmt::format("\"{}\" is no wall of the case, nor a set of walls", component),
                         "name patches that [boundary] makes walls, or what stands under [components]; a set "
                         "there gives a wall whose name has a \"+\" or \",\" another one");
      out.patches.insert(out.patches.end(), walls->second.begin(), walls->second.end());
    }
  if (std::set<std::string>(out.patches.begin(), out.patches.end()).size() != out.patches.size())
    throw InputError(where, 0, fmt::format("{} names a wall twice", name), "name each once");
  if (vanishes(out.coefficient, settings))
    throw InputError(where, 0, fmt::format("{} of a half model is zero", coefficient),
                     "name CA, CN or Cm, or mesh both halves");
  return out;
}

std::vector<Load> weights_of(const Functional& functional, const std::vector<std::string>& patch_names,
                             const FlightCondition& settings) {
  const Load weight = coefficient_weight(functional.coefficient, settings);
  std::vector<Load> out;
  for (const auto& patch : patch_names) {
    const bool counts = functional.patches.empty() ||
                        std::ranges::find(functional.patches, patch) != functional.patches.end();
    out.push_back(counts ? weight : Load{});
  }
  return out;
}

std::vector<Variable> variables_of(const Functional& functional, const FlightCondition& settings) {
  using enum Variable;
  const bool half = settings.reference.half_model;
  switch (functional.rates) {
    case 1:
      return half ? std::vector{alphadot} : std::vector{alphadot, betadot};
    case 2:
      return half ? std::vector{alphaddot} : std::vector{alphaddot, betaddot};
    default:
      return half ? std::vector{alpha, q} : std::vector{alpha, beta, p, q, r};
  }
}

std::string derivative_name(const Functional& functional, std::string_view variable) {
  return fmt::format("{}_{}{}", coefficient_names[static_cast<std::size_t>(functional.coefficient)], variable,
                     at_patches(functional));
}

Estimate derivative(const Adjoint& adjoint, Variable variable, const FlightCondition& settings) {
  const auto change = change_of(angle_of(variable), settings.freestream);
  const Real scale = rate_scale(variable, settings);
  return scale *
         Estimate{product(adjoint.sensitivity, change), product(adjoint.sensitivity_error, change, true)};
}

}  // namespace alphadot
