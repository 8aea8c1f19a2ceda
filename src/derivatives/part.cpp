#include "derivatives/part.hpp"

#include <algorithm>

namespace alphadot {

Components components_of(const Case& settings) {
  auto out = settings.components;
  for (const auto& [patch, kind] : settings.boundary)
    if (kind == BoundaryKind::wall) out[patch] = {patch};
  return out;
}

FlightCondition of_one_side(FlightCondition settings) {
  settings.reference.half_model = false;
  return settings;
}

Part::Part(std::span<const std::string> walls, std::span<const std::string> patch_names) : is_whole_(false) {
  for (const auto& wall : walls)
    walls_.push_back(static_cast<std::size_t>(std::ranges::find(patch_names, wall) - patch_names.begin()));
}

Load Part::of(std::span<const Load> loads, const Load& total) const {
  if (is_whole_) return total;
  Load out;
  for (const std::size_t wall : walls_) out += loads[wall];
  return out;
}

}  // namespace alphadot
