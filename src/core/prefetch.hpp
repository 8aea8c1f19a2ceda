// Asking the memory for what a loop needs soon, where the processor cannot guess it: loops over faces, points
// and rows read their cells from anywhere.
#pragma once

#include <cstddef>

namespace alphadot {

/// Starts to bring the bytes of `value` into the caches.
template <class V>
inline void prefetch(const V& value) {
  constexpr std::size_t line = 64;
  const char* at = reinterpret_cast<const char*>(&value);
  for (std::size_t byte = 0; byte < sizeof(V); byte += line) __builtin_prefetch(at + byte);
  __builtin_prefetch(at + sizeof(V) - 1);
}

}  // namespace alphadot
