#include "fuzz/check_mesh.hpp"
#include "io/ugrid_reader.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace alphadot;
  const std::string_view content = fuzz::text(data, size);
  for (const char* name : {".ugrid", ".b8.ugrid", ".lb8.ugrid", ".b4.ugrid", ".lr8.ugrid"})
    fuzz::check_mesh(size, [&] { return read_ugrid(content, "fuzz", *ugrid_form(name)); });
  const fuzz::LargestAllocation limit(size);
  try {
    read_mapbc(content, "fuzz.mapbc");
  } catch (const InputError&) {
    // Refusing is as good.
  }
  return 0;
}
