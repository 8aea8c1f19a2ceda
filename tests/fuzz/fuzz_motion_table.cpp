// Motion tables of strangers: a table or an InputError.
#include <cstdint>
#include <string_view>

#include "core/error.hpp"
#include "fuzz/largest_allocation.hpp"
#include "motion/motion_table.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace alphadot;
  const fuzz::LargestAllocation limit(size);
  try {
    parse_motion_table({reinterpret_cast<const char*>(data), size}, "fuzz.txt");
  } catch (const InputError&) {
    // Refusing is as good.
  }
  return 0;
}
