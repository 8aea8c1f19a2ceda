// Rows of varying length in two flat arrays.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "core/types.hpp"

namespace alphadot {

/// Compressed rows: the items of row i are items[begin[i] .. begin[i+1]).
struct Adjacency {
  std::vector<Index> begin{0};
  std::vector<Index> items;

  std::span<const Index> operator[](Index row) const {
    return {items.data() + begin[row], static_cast<std::size_t>(begin[row + 1] - begin[row])};
  }
  Index rows() const { return static_cast<Index>(begin.size()) - 1; }
};

/// The rows that each of `items` items belongs to, turned round: the items of each of `rows` rows, ascending.
/// `rows_of(item)` returns a range of row numbers; those outside [0, rows) are passed over.
template <class RowsOf>
Adjacency collect_rows(Index rows, Index items, RowsOf&& rows_of) {
  Adjacency out;
  out.begin.assign(static_cast<std::size_t>(rows) + 1, 0);
  const auto for_each_entry = [&](auto&& act) {
    for (Index item = items - 1; item >= 0; --item)
      for (const auto row : rows_of(item))
        if (row >= 0 && row < rows) act(out.begin[row], item);
  };
  // Counting sort: row lengths, then ends of the rows, which filling from behind moves down to their begins.
  for_each_entry([](Index& length, Index) { ++length; });
  Index end = 0;
  for (Index& begin : out.begin) begin = end += begin;
  out.items.resize(static_cast<std::size_t>(end));
  for_each_entry([&](Index& begin, Index item) { out.items[--begin] = item; });
  return out;
}

}  // namespace alphadot
