// Text files of columns of numbers under their names.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/types.hpp"

namespace alphadot {

/// A line of column names, then one line a point. Columns are separated by blanks or commas, # starts a
/// remark.
class ColumnTable {
 public:
  struct Kind {
    std::string what;                           ///< "a motion"
    std::span<const std::string_view> columns;  ///< that it may have; must have the first,
    std::string start;                          ///< which increases from 0, because of this
  };

  /// Throws InputError with `file` and line for anything else, and for fewer than two points.
  ColumnTable(std::string_view text, const std::string& file, const Kind& kind);

  bool has(std::string_view name) const;
  /// [points] of a column that it has.
  const std::vector<Real>& column(std::string_view name) const;

 private:
  void add_line(std::string_view line);
  void read_names(const std::vector<std::string_view>& words);
  void read_point(const std::vector<std::string_view>& words);
  [[noreturn]] void fail(const std::string& what, const std::string& remedy) const;
  std::string all_columns() const;

  std::string file_;
  Kind kind_;
  std::size_t most_rows_;
  int line_ = 0;
  std::vector<std::string> names_;
  std::vector<std::vector<Real>> columns_;
};

}  // namespace alphadot
