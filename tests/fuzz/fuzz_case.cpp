// Case files and overrides of strangers: a Case or an InputError, and what is accepted survives being written
// out.
#include <cstdint>
#include <cstdlib>
#include <string>

#include "case_file/case_file.hpp"
#include "core/error.hpp"
#include "fuzz/largest_allocation.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace alphadot;
  std::string text(reinterpret_cast<const char*>(data), size);
  // What follows a NUL is an override.
  std::vector<std::string> overrides;
  if (const auto end = text.find('\0'); end != std::string::npos) {
    overrides.push_back(text.substr(end + 1));
    text.resize(end);
  }
  static const std::string keys = describe_case_keys();  // made once
  const fuzz::LargestAllocation limit(size);
  try {
    const std::string resolved = resolved_case(parse_case(text, "/fuzz/case.toml", overrides));
    if (resolved_case(parse_case(resolved, "/elsewhere/case.toml")) != resolved) std::abort();
  } catch (const InputError&) {
    // Refusing is as good.
  }
  return 0;
}
