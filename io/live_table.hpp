// A CSV file that grows while a program runs, and its reader: for whoever wants to look on.
#pragma once

#include <fstream>
#include <string>
#include <string_view>
#include <vector>

#include "core/types.hpp"

namespace alphadot {

/// Rows of numbers under names, as read.
struct Table {
  std::vector<std::string> names;
  std::vector<std::vector<Real>> columns;  ///< [names][rows]

  std::size_t rows() const { return columns.empty() ? 0 : columns.front().size(); }
  /// Null when there is none.
  const std::vector<Real>* find(std::string_view name) const;
};

/// Reads a CSV file of numbers, without the comments above it; ends before the first row that is not whole,
/// such as one that is being written. Empty when the file cannot be read.
Table read_table(const std::string& path);

/// Writes a file row by row, each visible to readers at once. It is there to be looked at: when it cannot be
/// written the run goes on without it.
class LiveTable {
 public:
  /// Begins the file anew with `head`, whole lines.
  LiveTable(const std::string& path, std::string_view head) : out_(path, std::ios::binary) { append(head); }
  /// Adds whole lines.
  void append(std::string_view lines) { out_ << lines << std::flush; }

 private:
  std::ofstream out_;
};

}  // namespace alphadot
