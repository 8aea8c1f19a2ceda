#include "fuzz/check_mesh.hpp"
#include "io/gzip.hpp"
#include "io/su2_reader.hpp"

/// Damaged archives, and what comes out of sound ones as a mesh.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace alphadot;
  std::string content;
  try {
    // What the function promises: 100 times its input and 1 MiB.
    const fuzz::LargestAllocation limit(100 * size + (std::size_t{1} << 20), 1);
    content = gunzip(fuzz::text(data, size), "fuzz");
  } catch (const InputError&) {
    return 0;
  }
  fuzz::check_mesh(content.size(), [&] { return read_su2(content, "fuzz"); });
  return 0;
}
