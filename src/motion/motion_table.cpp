#include "motion/motion_table.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <vector>

#include "core/error.hpp"

namespace alphadot {

namespace {

constexpr std::array<std::string_view, 6> known_columns = {"t_star", "alpha", "theta", "x", "y", "z"};
constexpr const char* all_columns = "the columns are t_star, alpha, theta, x, y and z";

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

class TableReader {
 public:
  TableReader(std::string_view text, const std::string& file)
      // t_star increases, so that of many rows each has four characters at least.
      : file_(file),
        most_rows_(
            std::min(static_cast<std::size_t>(std::ranges::count(text, '\n')) + 1, text.size() / 4 + 2048)) {}

  void add_line(std::string_view line) {
    ++line_;
    const auto words = words_of_line(line);
    if (words.empty()) return;
    if (names_.empty())
      read_names(words);
    else
      read_point(words);
  }

  MotionTable finish() const {
    if (names_.empty()) throw InputError(file_, 0, "the table is empty", all_columns);
    const auto* time = column("t_star");
    if (!time) throw InputError(file_, 0, "the table has no column t_star", all_columns);
    if (time->size() < 2)
      throw InputError(file_, 0, "the table has fewer than two points",
                       "give at least the start and the end");
    MotionTable out;
    out.end = time->back();
    out.alpha = curve("alpha", radians_per_degree);
    out.theta = curve("theta", radians_per_degree);
    out.position[0] = curve("x", 1);
    out.position[1] = curve("y", 1);
    out.position[2] = curve("z", 1);
    if (out.alpha && out.has_position())
      throw InputError(file_, 0, "the table gives both alpha and a position, which follow from one another",
                       "leave out either alpha or x, y and z");
    return out;
  }

 private:
  [[noreturn]] void fail(const std::string& what, const std::string& remedy) const {
    throw InputError(file_, line_, what, remedy);
  }

  void read_names(const std::vector<std::string_view>& words) {
    for (const auto word : words) {
      const std::string name(word.substr(0, 40));
      if (std::ranges::find(known_columns, word) == known_columns.end())
        fail("\"" + name + "\" is not a column of a motion", all_columns);
      if (std::ranges::find(names_, name) != names_.end())
        fail("column " + name + " is there twice", "remove one of them");
      names_.push_back(name);
    }
    columns_.resize(names_.size());
    for (auto& values : columns_) values.reserve(most_rows_);
  }

  void read_point(const std::vector<std::string_view>& words) {
    if (words.size() != names_.size())
      fail(std::to_string(words.size()) + " numbers for " + std::to_string(names_.size()) + " columns",
           "give one number for each column");
    for (std::size_t i = 0; i < words.size(); ++i) {
      Real value = 0;
      const auto* end = words[i].data() + words[i].size();
      const auto [read, error] = std::from_chars(words[i].data(), end, value);
      if (error != std::errc{} || read != end || !std::isfinite(value))
        fail("\"" + std::string(words[i].substr(0, 40)) + "\" is not a number", "write it like -1.5e-3");
      auto& values = columns_[i];
      if (names_[i] == "t_star" && values.empty() && value != 0)
        fail("t_star does not start at 0", "a motion starts at t_star = 0, after the steady state");
      if (names_[i] == "t_star" && !values.empty() && value <= values.back())
        fail("t_star does not increase", "sort the points by time");
      values.push_back(value);
    }
  }

  const std::vector<Real>* column(std::string_view name) const {
    const auto found = std::ranges::find(names_, name);
    return found == names_.end() ? nullptr : &columns_[static_cast<std::size_t>(found - names_.begin())];
  }

  std::optional<Curve> curve(std::string_view name, Real unit) const {
    const auto* values = column(name);
    if (!values) return std::nullopt;
    std::vector<Real> scaled = *values;
    for (Real& value : scaled) value *= unit;
    return Curve(*column("t_star"), std::move(scaled));
  }

  std::string file_;
  std::size_t most_rows_;
  int line_ = 0;
  std::vector<std::string> names_;
  std::vector<std::vector<Real>> columns_;
};

}  // namespace

MotionTable parse_motion_table(std::string_view text, const std::string& file) {
  TableReader reader(text, file);
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    reader.add_line(text.substr(at, end - at));
    at = end + 1;
  }
  return reader.finish();
}

}  // namespace alphadot
