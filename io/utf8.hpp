// Names of files whose authors did not write UTF-8.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace alphadot {

/// Whether bytes are UTF-8 (RFC 3629), but for the ranges of code points that it leaves out.
inline bool is_utf8(std::string_view text) {
  std::size_t to_follow = 0;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    const bool follows = byte >> 6 == 0b10;
    if (follows != (to_follow > 0)) return false;
    if (follows)
      --to_follow;
    else if (byte >= 0x80)
      to_follow = byte >> 5 == 0b110 ? 1 : byte >> 4 == 0b1110 ? 2 : byte >> 3 == 0b11110 ? 3 : 9;
    if (to_follow == 9) return false;
  }
  return to_follow == 0;
}

/// The text as it is where it is UTF-8, else taken for Latin-1: TOML, JSON and HDF5 want the former.
inline std::string as_utf8(std::string_view text) {
  if (is_utf8(text)) return std::string(text);
  std::string out;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte >= 0x80) {
      out += static_cast<char>(0xc0 | (byte >> 6));
      out += static_cast<char>(0x80 | (byte & 0x3f));
    } else {
      out += c;
    }
  }
  return out;
}

}  // namespace alphadot
