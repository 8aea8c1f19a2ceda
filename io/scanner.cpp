#include "io/scanner.hpp"

#include <charconv>
#include <limits>
#include <system_error>
#include <type_traits>
#include <utility>

#include "core/error.hpp"

namespace alphadot {
namespace {

bool is_blank(char c) {
  return c == ' ' || (c >= '\t' && c <= '\r');
}

constexpr const char* damaged = "the file is damaged or was not written completely: write it again";

/// Reads 1.0D+00, as Fortran writes double precision: the letter is at `letter`. Returns where it ends.
const char* read_fortran_exponent(const char* first, const char* letter, const char* last, Real& value,
                                  std::errc& error) {
  std::array<char, 64> text;
  const auto size = std::min<std::size_t>(text.size(), static_cast<std::size_t>(last - first));
  std::copy_n(first, size, text.begin());
  text[std::min(size - 1, static_cast<std::size_t>(letter - first))] = 'e';
  const auto found = std::from_chars(text.data(), text.data() + size, value);
  error = found.ec;
  return first + (found.ptr - text.data());
}

}  // namespace

std::string quoted(std::string_view text) {
  constexpr std::size_t longest = 40;
  std::string out = "'";
  for (const char c : text.substr(0, longest)) out += c >= ' ' && c <= '~' ? c : '?';
  return out + (text.size() > longest ? "...'" : "'");
}

Scanner::Scanner(std::string_view content, std::string file, char comment)
    : content_(content), file_(std::move(file)), comment_(comment) {}

void Scanner::fail(const std::string& what, const std::string& remedy) const {
  fail_at(start_, what, remedy);
}

void Scanner::fail_at(std::size_t position, const std::string& what, const std::string& remedy) const {
  if (encoding_ != Encoding::text)
    throw InputError(file_, 0, what + " (at byte " + std::to_string(position) + ")", remedy);
  const auto line =
      1 + std::count(content_.begin(), content_.begin() + static_cast<std::ptrdiff_t>(position), '\n');
  const auto largest = std::ptrdiff_t{std::numeric_limits<int>::max()};
  throw InputError(file_, static_cast<int>(std::min(line, largest)), what, remedy);
}

void Scanner::fail_at_end(const char* meaning) const {
  fail(std::string("the file ends where ") + meaning + " should stand", damaged);
}

void Scanner::fail_not_finite(const char* meaning) const {
  fail(std::string(meaning) + " is not a finite number", damaged);
}

GlobalIndex Scanner::capacity(const RecordShape& shape) const {
  // As text, a number takes at least a digit and a blank; the last blank may be missing.
  const bool text = encoding_ == Encoding::text;
  const GlobalIndex bytes = text ? 2 * (shape.ints + shape.longs + shape.reals)
                                 : 4 * shape.ints + 8 * shape.longs + real_bytes_ * shape.reals;
  return (static_cast<GlobalIndex>(remaining()) + (text ? 1 : 0)) / bytes;
}

GlobalIndex Scanner::check_count(GlobalIndex count, const char* meaning, const RecordShape& shape) const {
  if (count < 0) fail(std::string(meaning) + " is negative: " + std::to_string(count), damaged);
  if (count > capacity(shape))
    fail(std::string(meaning) + " is " + std::to_string(count) + ", more than the " +
             std::to_string(remaining()) + " bytes left in the file can hold",
         damaged);
  return count;
}

void Scanner::skip_blanks() {
  while (position_ < content_.size()) {
    const char c = content_[position_];
    if (comment_ != '\0' && c == comment_)
      position_ = line_end();
    else if (is_blank(c))
      ++position_;
    else
      return;
  }
}

bool Scanner::at_end() {
  skip_blanks();
  return position_ == content_.size();
}

bool Scanner::at_end_of_line() {
  while (position_ < content_.size() && content_[position_] != '\n' && is_blank(content_[position_]))
    ++position_;
  if (position_ == content_.size() || content_[position_] == '\n') return true;
  return comment_ != '\0' && content_[position_] == comment_;
}

std::string_view Scanner::read_word(char stop) {
  skip_blanks();
  start_ = position_;
  while (position_ < content_.size()) {
    const char c = content_[position_];
    if (is_blank(c) || (stop != '\0' && c == stop) || (comment_ != '\0' && c == comment_)) break;
    ++position_;
  }
  return content_.substr(start_, position_ - start_);
}

std::size_t Scanner::line_end() const {
  return std::min(content_.find('\n', position_), content_.size());
}

std::string_view Scanner::peek_line() const {
  std::string_view line = content_.substr(position_, line_end() - position_);
  if (line.ends_with('\r')) line.remove_suffix(1);
  return line;
}

std::string_view Scanner::read_line() {
  start_ = position_;
  const std::string_view line = peek_line();
  position_ = std::min(line_end() + 1, content_.size());
  return line;
}

std::string_view Scanner::read_rest_of_line() {
  std::string_view line = read_line();
  if (comment_ != '\0') line = line.substr(0, line.find(comment_));
  while (!line.empty() && is_blank(line.front())) line.remove_prefix(1);
  while (!line.empty() && is_blank(line.back())) line.remove_suffix(1);
  return line;
}

bool Scanner::skip_past(std::string_view text) {
  const std::size_t found = content_.find(text, position_);
  if (found == std::string_view::npos) return false;
  position_ = found + text.size();
  return true;
}

bool Scanner::accept(char c) {
  if (at_end() || content_[position_] != c) return false;
  ++position_;
  return true;
}

void Scanner::expect(std::string_view word) {
  const std::string_view found = read_word();
  if (found == word) return;
  if (found.empty()) fail_at_end(std::string(word).c_str());
  fail(std::string(word) + " should stand here, not " + quoted(found), damaged);
}

bool Scanner::ends_number(const char* end) const {
  return end == content_.data() + content_.size() || is_blank(*end) || (comment_ != '\0' && *end == comment_);
}

template <class T>
T Scanner::read_text(const char* meaning, const char* kind) {
  skip_blanks();
  start_ = position_;
  const char* const last = content_.data() + content_.size();
  const char* first = content_.data() + position_;
  if (first == last) fail_at_end(meaning);
  // std::from_chars knows no leading plus, which some programs write.
  if (*first == '+' && last - first > 1 && first[1] != '-') ++first;
  T value{};
  auto [end, error] = std::from_chars(first, last, value);
  if constexpr (std::is_floating_point_v<T>)
    if (error == std::errc{} && end != last && std::string_view("dD").find(*end) != std::string_view::npos)
      end = read_fortran_exponent(first, end, last, value, error);
  if (error != std::errc{} || !ends_number(end)) {
    const std::string word = quoted(read_word());
    if (error == std::errc::result_out_of_range)
      fail(std::string(meaning) + " is out of range: " + word, damaged);
    fail(std::string(meaning) + " (" + kind + ") should stand here, not " + word, damaged);
  }
  position_ = static_cast<std::size_t>(end - content_.data());
  return value;
}

std::int32_t Scanner::read_text_int(const char* meaning) {
  return read_text<std::int32_t>(meaning, "a whole number");
}
std::int64_t Scanner::read_text_long(const char* meaning) {
  return read_text<std::int64_t>(meaning, "a whole number");
}
Real Scanner::read_text_real(const char* meaning) {
  return read_text<Real>(meaning, "a number");
}

void Scanner::skip_real(const char* meaning) {
  if (encoding_ != Encoding::text)
    read_binary_real(meaning);
  else if (read_word().empty())
    fail_at_end(meaning);
}

}  // namespace alphadot
