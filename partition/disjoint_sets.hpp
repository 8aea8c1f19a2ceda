// Items that are joined in pairs, and the sets that come of it.
#pragma once

#include <cstddef>
#include <numeric>
#include <vector>

#include "core/types.hpp"

namespace alphadot {

/// Union-find with path halving. The root of a set is its smallest item.
class DisjointSets {
 public:
  explicit DisjointSets(std::size_t items) : parent_(items) {
    std::iota(parent_.begin(), parent_.end(), Index{0});
  }

  Index root(Index item) {
    while (parent_[item] != item) item = parent_[item] = parent_[parent_[item]];
    return item;
  }
  void join(Index a, Index b) {
    a = root(a);
    b = root(b);
    if (a < b)
      parent_[b] = a;
    else
      parent_[a] = b;
  }
  /// The number of every item's set; sets are numbered by their smallest items, from 0.
  std::vector<Index> numbers() {
    std::vector<Index> out(parent_.size());
    Index sets = 0;
    for (Index item = 0; item < static_cast<Index>(parent_.size()); ++item)
      out[item] = parent_[item] == item ? sets++ : out[root(item)];
    return out;
  }

 private:
  std::vector<Index> parent_;
};

}  // namespace alphadot
