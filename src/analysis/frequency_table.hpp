// Derivatives at finite frequency as text.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "analysis/table.hpp"

namespace alphadot {

/// The response of one coefficient to a variable that oscillates, c = cos(k t*), t* = 2 V t / l: it is
/// (in_phase + i k out_of_phase) exp(i k t*), so that these are what the derivatives by the variable and by
/// its rate are for k -> 0.
struct FrequencyRow {
  Real k;                   ///< omega l / 2V
  std::string part;         ///< "total" or the name of a patch
  std::string coefficient;  ///< "Cm", ...
  Variable variable;
  Estimate in_phase, out_of_phase;
  bool converged = true;

  Real modulus() const;
  Real phase() const;  ///< degrees, of the load ahead of the variable
};

/// Comment lines with the head, a header, full precision.
std::string frequency_csv(std::span<const FrequencyRow> rows, const TableHead& head);

/// The rows of the whole configuration as rows of a table of derivatives, e.g. "Cm_alpha, k = 0.1" and
/// "Cm_alphadot, k = 0.1"; and what forced pitch and yaw about a fixed axis yield.
std::vector<TableRow> table_rows(std::span<const FrequencyRow> rows);

}  // namespace alphadot
