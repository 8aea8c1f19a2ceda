#include "io/toml_text.hpp"

#include <fmt/format.h>

namespace alphadot {

namespace {
constexpr int most_parts = 16;  ///< of one key

bool is_control(char c) {
  return (c >= 0 && c < 0x20) || c == 0x7f;
}
}  // namespace

std::string toml_string(std::string_view text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') out += '\\';
    if (is_control(c))
      out += fmt::format("\\u{:04X}", static_cast<int>(c));
    else
      out += c;
  }
  return out + '"';
}

Problem unsafe_line(std::string_view text) {
  int line = 1, dots = 0;
  char quote = 0;
  bool comment = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (c == '\n') {
      ++line;
      dots = 0;
      quote = 0;
      comment = false;
    } else if (comment) {
      continue;
    } else if (quote) {
      if (c == quote)
        quote = 0;
      else if (c == '\\' && quote == '"' && text.substr(i + 1, 1) != "\n")
        ++i;
    } else if (c == '"' || c == '\'') {
      if (text.substr(i, 3) == std::string(3, c))
        return {"", line, "multi-line text is not allowed here", ""};
      quote = c;
    } else if (c == '#') {
      comment = true;
    } else if (c == '.') {
      if (++dots >= most_parts) return {"", line, "the key has too many parts", ""};
    } else if (c == '=' || c == ',' || c == '[' || c == ']' || c == '{' || c == '}') {
      dots = 0;
    }
  }
  return {};
}

}  // namespace alphadot
