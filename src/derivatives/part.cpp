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

std::vector<std::size_t> numbers_of_patches(std::span<const std::string> patches,
                                            std::span<const std::string> patch_names) {
  std::vector<std::size_t> out;
  for (const auto& patch : patches)
    out.push_back(static_cast<std::size_t>(std::ranges::find(patch_names, patch) - patch_names.begin()));
  return out;
}

Part::Part(std::span<const std::string> walls, std::span<const std::string> patch_names)
    : is_whole_(false), walls_(numbers_of_patches(walls, patch_names)) {}

Load Part::of(std::span<const Load> loads, const Load& total) const {
  if (is_whole_) return total;
  Load out;
  for (const std::size_t wall : walls_) out += loads[wall];
  return out;
}

}  // namespace alphadot
