#include "support/counted_memory.hpp"

#include <malloc.h>

#include <algorithm>
#include <cstdlib>
#include <new>

using alphadot::testing_support::memory;

void* operator new(std::size_t size) {
  void* const block = std::malloc(size);
  if (block == nullptr) throw std::bad_alloc();
  memory.in_use += malloc_usable_size(block);
  memory.peak = std::max(memory.peak.load(), memory.in_use.load());
  memory.largest = std::max(memory.largest.load(), size);
  return block;
}
// The library's own calls the one above, a sanitizer's does not; std::stable_sort uses it.
void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
  try {
    return operator new(size);
  } catch (const std::bad_alloc&) {
    return nullptr;
  }
}
void operator delete(void* block) noexcept {
  memory.in_use -= malloc_usable_size(block);
  std::free(block);
}
void operator delete(void* block, std::size_t) noexcept {
  operator delete(block);
}
