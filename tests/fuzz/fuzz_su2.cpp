#include "fuzz/check_mesh.hpp"
#include "io/su2_reader.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace alphadot;
  fuzz::check_mesh(size, [&] { return read_su2(fuzz::text(data, size), "fuzz"); });
  return 0;
}
