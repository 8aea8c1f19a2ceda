// Finds a point by the tag that a mesh file gives it.
#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "core/types.hpp"

namespace alphadot {

/// Tags may be sparse and in any order: a table while they are nearly contiguous, a sorted list otherwise.
/// Memory: at most 16 bytes a point.
class TagIndex {
 public:
  TagIndex() = default;
  /// tags[i] is the tag of point i.
  explicit TagIndex(const std::vector<GlobalIndex>& tags);

  /// The point of `tag`; -1 when there is none. Constant time, or logarithmic for sparse tags.
  GlobalIndex find(GlobalIndex tag) const;
  /// A tag that two points have, if there is one.
  std::optional<GlobalIndex> duplicate() const { return duplicate_; }

 private:
  void fill_table(const std::vector<GlobalIndex>& tags);
  void fill_sorted(const std::vector<GlobalIndex>& tags);

  GlobalIndex first_ = 0;
  std::vector<GlobalIndex> table_;                           ///< point of tag first_ + i, or -1
  std::vector<std::pair<GlobalIndex, GlobalIndex>> sorted_;  ///< (tag, point)
  std::optional<GlobalIndex> duplicate_;
};

}  // namespace alphadot
