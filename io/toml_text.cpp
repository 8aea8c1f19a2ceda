#include "io/toml_text.hpp"

#include <fmt/format.h>

namespace alphadot {

namespace {
constexpr int most_parts = 16;         ///< of one key
constexpr int most_separators = 1000;  ///< commas and brackets: no key takes more than three values
constexpr std::string_view byte_order_mark = "\xef\xbb\xbf";

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
  int line = 1, dots = 0, separators = 0;
  char quote = 0;      // that is open
  char before = '\n';  // the last character outside quotes that is not a blank
  bool comment = false;
  for (std::size_t i = text.starts_with(byte_order_mark) ? byte_order_mark.size() : 0; i < text.size(); ++i) {
    const char c = text[i];
    if (c == '\n') {
      ++line;
      dots = 0;
      quote = 0;
      before = c;
      comment = false;
    } else if (c == '\r' || c == '\t' || c == ' ') {
      continue;
    } else if (is_control(c)) {
      return {"", line, "a control character", "is it text?"};
    } else if (comment) {
      continue;
    } else if (quote) {
      if (c == quote)
        quote = 0;
      else if (c == '\\' && quote == '"' && text.substr(i + 1, 1) != "\n")
        ++i;
    } else if (c == '#') {
      comment = true;
    } else {
      if (c == '"' || c == '\'') {
        if (text.substr(i, 3) == std::string(3, c))
          return {"", line, "multi-line text is not allowed here", ""};
        if (std::string_view("\n=,.[{").find(before) == std::string_view::npos)
          return {"", line, "a quote in the middle of a key or value", ""};
        quote = c;
      } else if (static_cast<unsigned char>(c) > 127) {
        return {"", line, "a character that is not ASCII",
                "such characters may stand in quotes and comments only"};
      } else if (c == '.') {
        if (++dots >= most_parts) return {"", line, "the key has too many parts", ""};
      } else if (std::string_view("=,[]{}").find(c) != std::string_view::npos) {
        dots = 0;
      }
      if ((c == ',' || c == '[') && ++separators > most_separators)
        return {"", line, "more values than a case has", "is it a case file?"};
      before = c;
    }
  }
  return {};
}

}  // namespace alphadot
