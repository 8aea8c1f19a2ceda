// Growth of the arrays that a reader of meshes fills: never out of proportion to its file.
#pragma once

#include <algorithm>
#include <cstddef>
#include <string>
#include <vector>

#include "core/types.hpp"

namespace alphadot {

/// Most bytes of one array: twice the file, and 16 KiB for small files. No mesh needs more. As text a point
/// may be as short as "0 0 0", 6 bytes for 24 in memory, and an element 10 for 32; but a mesh uses each of
/// its points, by numbers that differ. n points take n (7 + the mean number of digits) bytes in the file at
/// least, so that 24 n exceeds twice the file by 7 KiB at most, at 10,000 points; elements, of which n points
/// allow no more than n^2 / 2, by 14 KiB, at 100 points. In binary a number has 4 bytes or more, 8 in memory.
/// `in` is what is read: a Scanner, or anything else that knows the size() of its file and can fail().
template <class Source>
std::size_t largest_array(const Source& in) {
  return 2 * in.size() + 16384;
}

/// Makes room for `count` more entries, as far as largest_array() goes. Grows geometrically, so that many
/// small blocks stay cheap; exact for the first one.
template <class T, class Source>
void reserve_more(std::vector<T>& entries, GlobalIndex count, const Source& in) {
  const std::size_t needed = entries.size() + static_cast<std::size_t>(count);
  if (needed > entries.capacity())
    entries.reserve(std::min(largest_array(in) / sizeof(T),
                             std::max(needed, entries.capacity() + entries.capacity() / 2)));
}

/// Adds an entry. Fails when the array is as large as it may be.
template <class T, class Source>
T& append(std::vector<T>& entries, const T& entry, const Source& in) {
  if (entries.size() == entries.capacity()) {
    reserve_more(entries, 1, in);
    if (entries.size() == entries.capacity())
      in.fail("there are more entries than a file of " + std::to_string(in.size()) + " bytes can tell apart",
              "the file repeats points or elements: write it again");
  }
  return entries.emplace_back(entry);
}

}  // namespace alphadot
