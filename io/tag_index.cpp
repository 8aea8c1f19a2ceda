#include "io/tag_index.hpp"

#include <algorithm>
#include <cstdint>
#include <limits>

namespace alphadot {
namespace {

/// tag - first without overflow; tags below `first` come out huge.
std::uint64_t distance(GlobalIndex first, GlobalIndex tag) {
  return static_cast<std::uint64_t>(tag) - static_cast<std::uint64_t>(first);
}

}  // namespace

TagIndex::TagIndex(const std::vector<GlobalIndex>& tags) {
  if (tags.empty()) return;
  const auto [smallest, largest] = std::minmax_element(tags.begin(), tags.end());
  first_ = *smallest;
  if (distance(first_, *largest) < 2 * tags.size()) {
    table_.assign(distance(first_, *largest) + 1, -1);
    fill_table(tags);
  } else {
    fill_sorted(tags);
  }
}

void TagIndex::fill_table(const std::vector<GlobalIndex>& tags) {
  GlobalIndex point = 0;
  for (const GlobalIndex tag : tags) {
    GlobalIndex& entry = table_[distance(first_, tag)];
    if (entry >= 0) duplicate_ = tag;
    entry = point++;
  }
}

void TagIndex::fill_sorted(const std::vector<GlobalIndex>& tags) {
  sorted_.reserve(tags.size());
  GlobalIndex point = 0;
  for (const GlobalIndex tag : tags) sorted_.emplace_back(tag, point++);
  std::sort(sorted_.begin(), sorted_.end());
  const auto same_tag = [](const auto& a, const auto& b) { return a.first == b.first; };
  const auto twice = std::adjacent_find(sorted_.begin(), sorted_.end(), same_tag);
  if (twice != sorted_.end()) duplicate_ = twice->first;
}

GlobalIndex TagIndex::find(GlobalIndex tag) const {
  if (!table_.empty()) {
    const std::uint64_t entry = distance(first_, tag);
    return entry < table_.size() ? table_[entry] : -1;
  }
  const auto found = std::lower_bound(sorted_.begin(), sorted_.end(),
                                      std::pair{tag, std::numeric_limits<GlobalIndex>::min()});
  return found != sorted_.end() && found->first == tag ? found->second : -1;
}

}  // namespace alphadot
