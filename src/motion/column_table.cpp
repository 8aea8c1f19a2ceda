#include "motion/column_table.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "core/error.hpp"

namespace alphadot {

namespace {

/// The words of a line, without its remark.
std::vector<std::string_view> words_of_line(std::string_view line) {
  constexpr std::string_view separators = " \t\r,;";
  line = line.substr(0, line.find('#'));
  std::vector<std::string_view> out;
  for (std::size_t at = 0; (at = line.find_first_not_of(separators, at)) != std::string_view::npos;) {
    const std::size_t end = std::min(line.find_first_of(separators, at), line.size());
    out.push_back(line.substr(at, end - at));
    at = end;
  }
  return out;
}

}  // namespace

ColumnTable::ColumnTable(std::string_view text, const std::string& file, const Kind& kind)
    // The first column increases, so that of many rows each has four characters at least.
    : file_(file),
      kind_(kind),
      most_rows_(
          std::min(static_cast<std::size_t>(std::ranges::count(text, '\n')) + 1, text.size() / 4 + 2048)) {
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    add_line(text.substr(at, end - at));
    at = end + 1;
  }
  const std::string_view first = kind.columns.front();
  if (names_.empty()) throw InputError(file, 0, "the table is empty", all_columns());
  if (!has(first)) throw InputError(file, 0, "the table has no column " + std::string(first), all_columns());
  if (column(first).size() < 2)
    throw InputError(file, 0, "the table has fewer than two points", "give at least the start and the end");
}

bool ColumnTable::has(std::string_view name) const {
  return std::ranges::find(names_, name) != names_.end();
}

const std::vector<Real>& ColumnTable::column(std::string_view name) const {
  return columns_.at(static_cast<std::size_t>(std::ranges::find(names_, name) - names_.begin()));
}

void ColumnTable::fail(const std::string& what, const std::string& remedy) const {
  throw InputError(file_, line_, what, remedy);
}

std::string ColumnTable::all_columns() const {
  std::string out = "the columns are ";
  for (std::size_t i = 0; i < kind_.columns.size(); ++i) {
    if (i > 0) out += i + 1 < kind_.columns.size() ? ", " : " and ";
    out += kind_.columns[i];
  }
  return out;
}

void ColumnTable::add_line(std::string_view line) {
  ++line_;
  const auto words = words_of_line(line);
  if (words.empty()) return;
  if (names_.empty())
    read_names(words);
  else
    read_point(words);
}

void ColumnTable::read_names(const std::vector<std::string_view>& words) {
  for (const auto word : words) {
    const std::string name(word.substr(0, 40));
    if (std::ranges::find(kind_.columns, word) == kind_.columns.end())
      fail("\"" + name + "\" is not a column of " + kind_.what, all_columns());
    if (std::ranges::find(names_, name) != names_.end())
      fail("column " + name + " is there twice", "remove one of them");
    names_.push_back(name);
  }
  columns_.resize(names_.size());
  for (auto& values : columns_) values.reserve(most_rows_);
}

void ColumnTable::read_point(const std::vector<std::string_view>& words) {
  if (words.size() != names_.size())
    fail(std::to_string(words.size()) + " numbers for " + std::to_string(names_.size()) + " columns",
         "give one number for each column");
  const std::string first(kind_.columns.front());
  for (std::size_t i = 0; i < words.size(); ++i) {
    Real value = 0;
    const auto* end = words[i].data() + words[i].size();
    const auto [read, error] = std::from_chars(words[i].data(), end, value);
    if (error != std::errc{} || read != end || !std::isfinite(value))
      fail("\"" + std::string(words[i].substr(0, 40)) + "\" is not a number", "write it like -1.5e-3");
    auto& values = columns_[i];
    if (names_[i] == first && values.empty() && value != 0) fail(first + " does not start at 0", kind_.start);
    if (names_[i] == first && !values.empty() && value <= values.back())
      fail(first + " does not increase", "sort the points by " + first);
    values.push_back(value);
  }
}

}  // namespace alphadot
