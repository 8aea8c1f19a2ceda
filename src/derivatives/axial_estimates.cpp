#include "derivatives/axial_estimates.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace alphadot {

namespace {

constexpr Real fastest_base = 5;  // Mach number that the correlation goes up to

/// Of walls that are taken together.
template <class IsPart>
Plate plate_of(const Configuration& configuration, const std::vector<std::string>& names,
               const IsPart& is_part) {
  Real area = 0, first = 0, last = 0;
  for (std::size_t patch = 0; patch < names.size(); ++patch) {
    const WettedWall& wall = configuration.walls[patch];
    if (wall.area == 0 || !is_part(names[patch])) continue;
    first = area > 0 ? std::min(first, wall.first) : wall.first;
    last = area > 0 ? std::max(last, wall.last) : wall.last;
    area += wall.area;
  }
  return {area, last - first};
}

std::vector<Plate> plates_of(const Configuration& configuration, const std::vector<std::string>& names,
                             const Components& components) {
  const auto is_in = [](const std::vector<std::string>& set, const std::string& name) {
    return std::ranges::find(set, name) != set.end();
  };
  std::vector<Plate> out;
  std::vector<std::string> taken;  // a wall in several sets counts in the first
  for (const auto& component : components) {
    const auto& set = component.second;
    out.push_back(plate_of(configuration, names,
                           [&](const std::string& name) { return is_in(set, name) && !is_in(taken, name); }));
    taken.insert(taken.end(), set.begin(), set.end());
  }
  out.push_back(plate_of(configuration, names, [&](const std::string& name) { return !is_in(taken, name); }));
  return out;
}

}  // namespace

std::vector<AxialEstimate> axial_estimates(const Configuration& configuration,
                                           const std::vector<std::string>& patch_names,
                                           const Case& settings) {
  const Real mach = settings.freestream.mach;
  std::vector<AxialEstimate> out;
  if (configuration.base_area > 0 && mach <= fastest_base)
    out.push_back(
        {"base", -base_pressure(mach, settings.freestream.gamma) * configuration.base_area,
         fmt::format("{:.3g} reference areas, no motor burning; Fleeman 2001", configuration.base_area)});
  if (settings.estimates.reynolds > 0 && configuration.has_body) {
    const auto plates = plates_of(configuration, patch_names, settings.components);
    out.push_back(
        {"friction", friction_force(plates, mach, settings.estimates),
         fmt::format("flat plates of {:.3g} reference areas, Reynolds number {:.3g} a reference "
                     "length, transition at {:.3g}; van Driest 1956",
                     configuration.wall_area, settings.estimates.reynolds, settings.estimates.transition)});
  }
  return out;
}

}  // namespace alphadot
