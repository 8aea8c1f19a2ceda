// Tables as text: comma-separated values, with comments above them.
#pragma once

#include <string>
#include <string_view>

namespace alphadot {

/// Every line of `text` behind "# ".
inline std::string csv_comment(std::string_view text) {
  std::string out;
  while (!text.empty()) {
    const auto end = text.find('\n');
    out.append("# ").append(text.substr(0, end)) += '\n';
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
  }
  return out;
}

/// A line of cells, each in quotes where it has to be (RFC 4180).
template <class Cells>
std::string csv_line(const Cells& cells) {
  std::string out;
  bool is_first = true;
  for (const std::string_view cell : cells) {
    if (!is_first) out += ',';
    is_first = false;
    if (cell.find_first_of(",\"\n") == std::string_view::npos) {
      out += cell;
      continue;
    }
    out += '"';
    for (const char c : cell) out.append(c == '"' ? 2 : 1, c);
    out += '"';
  }
  return out + '\n';
}

}  // namespace alphadot
