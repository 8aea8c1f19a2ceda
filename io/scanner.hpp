// A cursor over the bytes of a mesh file that reads numbers written as text or in binary.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>

#include "core/types.hpp"

namespace alphadot {

/// How numbers stand in the bytes of a file.
enum class Encoding { text, little_endian, big_endian };

inline constexpr Encoding native_encoding =
    std::endian::native == std::endian::little ? Encoding::little_endian : Encoding::big_endian;
inline constexpr Encoding swapped_encoding =
    std::endian::native == std::endian::little ? Encoding::big_endian : Encoding::little_endian;

/// How many numbers of each kind one record holds at least.
struct RecordShape {
  GlobalIndex ints = 0;   ///< 32-bit integers
  GlobalIndex longs = 0;  ///< 64-bit integers
  GlobalIndex reals = 0;
};

/// Reads on from one place of `content`, which must outlive the scanner. Every mistake is an InputError that
/// names the file and its line (text) or byte (binary). Nothing is allocated on the way of success, and
/// counts are let through only when the rest of the file can hold as many records.
class Scanner {
 public:
  /// `comment` starts a remark that lasts to the end of the line; '\0' for none.
  Scanner(std::string_view content, std::string file, char comment = '\0');

  void set_encoding(Encoding encoding) { encoding_ = encoding; }
  /// Reals in binary have 64 bits unless told to have 32.
  void set_single_reals() { real_bytes_ = 4; }
  Encoding encoding() const { return encoding_; }
  const std::string& file() const { return file_; }
  /// Bytes of the whole file.
  std::size_t size() const { return content_.size(); }
  std::size_t position() const { return position_; }
  std::size_t remaining() const { return content_.size() - position_; }

  /// The next number. `meaning` names it in messages: "a node tag". Reals are finite.
  std::int32_t read_int(const char* meaning) {
    return encoding_ == Encoding::text ? read_text_int(meaning) : read_binary<std::int32_t>(meaning);
  }
  std::int64_t read_long(const char* meaning) {
    return encoding_ == Encoding::text ? read_text_long(meaning) : read_binary<std::int64_t>(meaning);
  }
  Real read_real(const char* meaning) {
    const Real value = encoding_ == Encoding::text ? read_text_real(meaning) : read_binary_real(meaning);
    if (!std::isfinite(value)) fail_not_finite(meaning);
    return value;
  }
  /// Passes over a real whatever its value.
  void skip_real(const char* meaning);

  /// A number of records of at least `shape` each, which the rest of the file must be long enough to hold.
  GlobalIndex read_int_count(const char* meaning, const RecordShape& shape) {
    return check_count(read_int(meaning), meaning, shape);
  }
  GlobalIndex read_long_count(const char* meaning, const RecordShape& shape) {
    return check_count(read_long(meaning), meaning, shape);
  }
  /// The same for a count that has been read before.
  GlobalIndex check_count(GlobalIndex count, const char* meaning, const RecordShape& shape) const;
  /// How many records of `shape` the rest of the file can hold.
  GlobalIndex capacity(const RecordShape& shape) const;
  /// Passes over `bytes` bytes. They must be there.
  void skip(std::size_t bytes) { position_ += bytes; }

  /// Passes over the mark that some programs put at the beginning of text.
  void skip_byte_order_mark() {
    if (content_.substr(position_).starts_with("\xef\xbb\xbf")) position_ += 3;
  }
  /// True when nothing but blanks and comments is left; otherwise stands at the next word.
  bool at_end();
  /// True when nothing but blanks and a comment is left on this line.
  bool at_end_of_line();
  /// The next run of characters up to a blank, a comment or `stop`; empty at the end of the file.
  std::string_view read_word(char stop = '\0');
  /// What is left of this line, without its end, which is consumed.
  std::string_view read_line();
  /// The same without blanks around it and without a comment.
  std::string_view read_rest_of_line();
  /// The line without consuming it.
  std::string_view peek_line() const;
  /// Passes over everything up to and with the next `text`; false, and no move, when it never comes.
  bool skip_past(std::string_view text);
  /// Consumes `c` when it comes next, blanks and comments aside.
  bool accept(char c);
  /// The next word must be `word`.
  void expect(std::string_view word);

  /// Throws InputError for the number or word read last (or, with `position`, for that byte of the file).
  [[noreturn]] void fail(const std::string& what, const std::string& remedy = "") const;
  [[noreturn]] void fail_at(std::size_t position, const std::string& what,
                            const std::string& remedy = "") const;

 private:
  template <class T>
  T read_binary(const char* meaning) {
    start_ = position_;
    if (remaining() < sizeof(T)) fail_at_end(meaning);
    std::array<char, sizeof(T)> bytes;
    std::memcpy(bytes.data(), content_.data() + position_, sizeof(T));
    if (encoding_ != native_encoding) std::reverse(bytes.begin(), bytes.end());
    position_ += sizeof(T);
    return std::bit_cast<T>(bytes);
  }
  Real read_binary_real(const char* meaning) {
    return real_bytes_ == 8 ? read_binary<double>(meaning) : read_binary<float>(meaning);
  }
  template <class T>
  T read_text(const char* meaning, const char* kind);
  bool ends_number(const char* end) const;
  std::int32_t read_text_int(const char* meaning);
  std::int64_t read_text_long(const char* meaning);
  Real read_text_real(const char* meaning);
  void skip_blanks();
  std::size_t line_end() const;
  [[noreturn]] void fail_at_end(const char* meaning) const;
  [[noreturn]] void fail_not_finite(const char* meaning) const;

  std::string_view content_;
  std::string file_;
  char comment_;
  Encoding encoding_ = Encoding::text;
  GlobalIndex real_bytes_ = 8;
  std::size_t position_ = 0;
  std::size_t start_ = 0;  ///< where the number or word read last begins
};

/// `text` fit for a message: cut after 40 characters and without control characters.
std::string quoted(std::string_view text);

}  // namespace alphadot
