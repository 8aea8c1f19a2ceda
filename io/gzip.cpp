#include "io/gzip.hpp"

#include <zlib.h>

#include <algorithm>
#include <cstddef>
#include <limits>
#include <memory>

#include "core/error.hpp"

namespace alphadot {

bool is_gzip(std::string_view content) {
  return content.starts_with("\x1f\x8b");
}

std::string gunzip(std::string_view content, const std::string& file) {
  const auto fail = [&](const std::string& what) {
    throw InputError(file, 0, "the file cannot be decompressed: " + what, "gunzip it, or write it again");
  };
  z_stream stream{};
  if (inflateInit2(&stream, 16 + MAX_WBITS) != Z_OK) fail("no memory");  // 16: of gzip
  const std::unique_ptr<z_stream, decltype(&inflateEnd)> end(&stream, &inflateEnd);

  const std::size_t most = 100 * content.size() + (std::size_t{1} << 20);
  constexpr std::size_t piece = std::numeric_limits<uInt>::max() / 2;
  std::string out;
  std::size_t read = 0, written = 0;
  int status = Z_OK;
  while (status != Z_STREAM_END || read < content.size()) {
    // A file may be of several members, one after the other.
    if (status == Z_STREAM_END && inflateReset(&stream) != Z_OK) fail("it is damaged");
    if (written == out.size()) {
      if (written >= most) fail("it holds more than 100 times its size");
      out.resize(std::min(most, std::max<std::size_t>(4 * content.size(), written + written / 2)));
    }
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(content.data() + read));
    stream.avail_in = static_cast<uInt>(std::min(piece, content.size() - read));
    stream.next_out = reinterpret_cast<Bytef*>(out.data() + written);
    stream.avail_out = static_cast<uInt>(std::min(piece, out.size() - written));
    const uInt in_before = stream.avail_in, out_before = stream.avail_out;
    status = inflate(&stream, Z_NO_FLUSH);
    read += in_before - stream.avail_in;
    written += out_before - stream.avail_out;
    if (status != Z_OK && status != Z_STREAM_END)
      fail(status == Z_BUF_ERROR ? "it ends too early" : "it is damaged");
    if (status == Z_OK && read == content.size() && stream.avail_out > 0) fail("it ends too early");
  }
  out.resize(written);
  return out;
}

}  // namespace alphadot
