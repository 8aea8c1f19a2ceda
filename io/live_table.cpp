#include "io/live_table.hpp"

#include <algorithm>
#include <charconv>
#include <sstream>

#include "io/files.hpp"

namespace alphadot {

namespace {

std::vector<std::string_view> cells_of(std::string_view line) {
  std::vector<std::string_view> out;
  for (std::size_t comma; (comma = line.find(',')) != std::string_view::npos; line.remove_prefix(comma + 1))
    out.push_back(line.substr(0, comma));
  out.push_back(line);
  return out;
}

bool parse(std::string_view text, Real& value) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc{} && end == text.data() + text.size();
}

}  // namespace

const std::vector<Real>* Table::find(std::string_view name) const {
  const auto found = std::ranges::find(names, name);
  return found == names.end() ? nullptr : &columns[static_cast<std::size_t>(found - names.begin())];
}

Table read_table(const std::string& path) {
  Table out;
  std::istringstream in(content_of(path));
  std::string line;
  do {
    if (!std::getline(in, line)) return out;
  } while (line.starts_with('#'));
  for (const auto name : cells_of(line)) out.names.emplace_back(name);
  out.columns.resize(out.names.size());
  while (std::getline(in, line) && !in.eof()) {  // a line without its end is not whole yet
    const auto cells = cells_of(line);
    std::vector<Real> row(cells.size());
    if (cells.size() != out.names.size() || !std::ranges::equal(cells, row, parse)) break;
    for (std::size_t i = 0; i < row.size(); ++i) out.columns[i].push_back(row[i]);
  }
  return out;
}

}  // namespace alphadot
