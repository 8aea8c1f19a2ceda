// What a fuzzed function owes besides not crashing: no block of memory out of proportion to its input.
#pragma once

#include <sanitizer/allocator_interface.h>

#include <cstddef>
#include <cstdlib>

namespace alphadot::fuzz {

/// While it lives, a block larger than `share` times the `size` of the input ends the program. 16 KiB of
/// room: what io/bounded_growth.hpp grants small files; names and messages need less.
class LargestAllocation {
 public:
  explicit LargestAllocation(std::size_t size, std::size_t share = 2) {
    [[maybe_unused]] static const int hooks =
        __sanitizer_install_malloc_and_free_hooks(check, [](const volatile void*) {});
    limit_ = share * size + 16384;
  }
  ~LargestAllocation() { limit_ = 0; }
  LargestAllocation(const LargestAllocation&) = delete;
  LargestAllocation& operator=(const LargestAllocation&) = delete;

 private:
  static void check(const volatile void*, std::size_t size) {
    if (limit_ > 0 && size > limit_) std::abort();
  }
  static inline std::size_t limit_ = 0;
};

}  // namespace alphadot::fuzz
