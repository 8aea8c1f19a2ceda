// Counts what a test program takes by operator new, which counted_memory.cpp defines.
#pragma once

#include <atomic>
#include <cstddef>

namespace alphadot::testing_support {

/// Bytes since the last reset(). Atomic, because MPI has threads of its own.
struct CountedMemory {
  std::atomic<std::size_t> in_use{0};   ///< now, not reset
  std::atomic<std::size_t> peak{0};     ///< at most in use at one time
  std::atomic<std::size_t> largest{0};  ///< the largest single block

  void reset() {
    peak = in_use.load();
    largest = 0;
  }
};
inline CountedMemory memory;

}  // namespace alphadot::testing_support
