#include "fuzz/check_mesh.hpp"
#include "io/su2_reader.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  alphadot::fuzz::check_mesh([&] { return alphadot::read_su2(alphadot::fuzz::text(data, size), "fuzz"); });
  return 0;
}
