// Derivatives as text that a person or a spreadsheet reads.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "analysis/axes.hpp"
#include "core/case.hpp"

namespace alphadot {

/// One line of a table.
struct TableRow {
  std::string name;  ///< as in result.json, "Cm_alphadot"
  Estimate value;
  std::string method;  ///< "plunge, k = 0.01", "linear solve", ...
};

/// A row for each entry of the set, column by column; what symmetry makes exactly zero is left out.
std::vector<TableRow> rows_of(const DerivativeSet& derivatives, const std::string& method,
                              Axes axes = Axes::body);

/// What every number refers to: reference length and area, moment centre, axes, normalisation of rates.
std::string reference_text(const ReferenceSettings& reference, Axes axes = Axes::body);

/// Aligned lines "name value ± uncertainty method" below the reference text.
std::string derivative_table(std::span<const TableRow> rows, const ReferenceSettings& reference,
                             Axes axes = Axes::body);

/// The same as comma-separated values: comment lines with the reference, a header, full precision.
std::string derivative_csv(std::span<const TableRow> rows, const ReferenceSettings& reference,
                           Axes axes = Axes::body);

}  // namespace alphadot
