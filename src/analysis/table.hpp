// Derivatives as text that a person or a spreadsheet reads.
#pragma once

#include <span>
#include <string>
#include <utility>
#include <vector>

#include "analysis/axes.hpp"
#include "core/case.hpp"

namespace alphadot {

/// One source of uncertainty, "linear", "limiter" or "mesh", and its share in that of every entry.
struct UncertaintyPart {
  std::string source;
  DerivativeSetOf<Real> share;
};

/// One line of a table.
struct TableRow {
  std::string name;  ///< as in result.json, "Cm_alphadot"
  Estimate value;
  std::string method;                                    ///< "plunge, k = 0.01", "linear solve", ...
  std::vector<std::pair<std::string, Real>> parts = {};  ///< of the uncertainty, by source; may be empty
};

/// A row for each entry of the set, column by column; what symmetry makes exactly zero is left out. The parts
/// are those that the uncertainties of the set are the sums of, in all of its columns.
std::vector<TableRow> rows_of(const DerivativeSet& derivatives, const std::string& method,
                              Axes axes = Axes::body, std::span<const UncertaintyPart> parts = {});

/// What every number refers to: reference length and area, moment centre, axes, normalisation of rates.
std::string reference_text(const ReferenceSettings& reference, Axes axes = Axes::body);

/// Aligned lines "name value ± uncertainty method" below the reference text, with a column for each part of
/// the uncertainty, the same in all rows.
std::string derivative_table(std::span<const TableRow> rows, const ReferenceSettings& reference,
                             Axes axes = Axes::body);

/// The same as comma-separated values: comment lines with the reference, a header, full precision; the parts
/// behind the method.
std::string derivative_csv(std::span<const TableRow> rows, const ReferenceSettings& reference,
                           Axes axes = Axes::body);

}  // namespace alphadot
