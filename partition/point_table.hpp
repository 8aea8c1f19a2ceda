// The points that some of a rank's cells use, found by their global ids.
#pragma once

#include <algorithm>
#include <vector>

#include "core/types.hpp"
#include "core/vec3.hpp"

namespace alphadot {

struct PointTable {
  std::vector<GlobalIndex> ids;  ///< ascending
  std::vector<Vec3> at;          ///< mesh units

  /// Position of an id that may be missing (then: ids.size()).
  std::size_t find(GlobalIndex id) const {
    const auto found = std::lower_bound(ids.begin(), ids.end(), id);
    return found != ids.end() && *found == id ? static_cast<std::size_t>(found - ids.begin()) : ids.size();
  }
  const Vec3& operator[](GlobalIndex id) const { return at[find(id)]; }
};

/// The distinct point ids of elements, ascending.
template <class Elements>
std::vector<GlobalIndex> used_points(const Elements& elements) {
  std::vector<GlobalIndex> ids;
  ids.reserve(elements.size() * std::size(elements.front()));
  for (const auto& element : elements) ids.insert(ids.end(), element.begin(), element.end());
  std::sort(ids.begin(), ids.end());
  ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
  ids.shrink_to_fit();
  return ids;
}

}  // namespace alphadot
