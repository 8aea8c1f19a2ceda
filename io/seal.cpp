#include "io/seal.hpp"

#include <fmt/format.h>
#include <xxhash.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <memory>
#include <vector>

#include "core/error.hpp"

namespace alphadot {
namespace {

/// What stands at the end of a sealed file, in the byte order of the machine as everything else in it.
struct Seal {
  std::array<char, 8> mark{'a', 'l', 'p', 'h', 'a', 'd', 'o', 't'};
  std::uint64_t size = 0;  ///< of the content
  std::uint64_t hash = 0;  ///< xxhash64 of the content
};

/// Of the next `size` bytes.
std::uint64_t hash_of(std::istream& in, std::uint64_t size, const std::string& path) {
  const std::unique_ptr<XXH64_state_t, decltype(&XXH64_freeState)> state(XXH64_createState(),
                                                                         &XXH64_freeState);
  XXH64_reset(state.get(), 0);
  std::vector<char> piece(std::min<std::uint64_t>(size, std::uint64_t{1} << 20));
  for (std::uint64_t done = 0; done < size;) {
    const auto count = std::min<std::uint64_t>(piece.size(), size - done);
    if (!in.read(piece.data(), static_cast<std::streamsize>(count)))
      throw InputError(path, 0, "cannot be read back");
    XXH64_update(state.get(), piece.data(), count);
    done += count;
  }
  return XXH64_digest(state.get());
}

std::uint64_t size_of(const std::string& path) {
  std::error_code error;
  const auto size = std::filesystem::file_size(path, error);
  if (error) throw InputError(path, 0, "cannot be read: " + error.message());
  return size;
}

}  // namespace

std::string content_hash(std::string_view content) {
  return fmt::format("{:016x}", XXH64(content.data(), content.size(), 0));
}

void seal_file(const std::string& path) {
  Seal seal;
  seal.size = size_of(path);
  std::fstream file(path, std::ios::binary | std::ios::in | std::ios::out);
  if (!file) throw InputError(path, 0, "cannot be read back");
  seal.hash = hash_of(file, seal.size, path);
  file.seekp(0, std::ios::end);
  file.write(reinterpret_cast<const char*>(&seal), sizeof(seal));
  file.close();
  if (!file) throw InputError(path, 0, "cannot be written", "check free space and quota");
}

void check_seal(const std::string& path) {
  const auto size = size_of(path);
  std::ifstream file(path, std::ios::binary);
  if (!file) throw InputError(path, 0, "cannot be opened", "check its permissions");
  Seal seal;
  if (size < sizeof(seal)) throw InputError(path, 0, "is cut short or empty");
  const auto content = size - sizeof(seal);
  const auto hash = hash_of(file, content, path);
  file.read(reinterpret_cast<char*>(&seal), sizeof(seal));
  if (!file || seal.mark != Seal{}.mark || seal.size != content)
    throw InputError(path, 0, "is cut short or was never completed");
  if (seal.hash != hash) throw InputError(path, 0, "is damaged: its bytes are not those that were written");
}

}  // namespace alphadot
