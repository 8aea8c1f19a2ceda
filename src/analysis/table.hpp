// Derivatives as text that a person or a spreadsheet reads.
#pragma once

#include <set>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "analysis/axes.hpp"
#include "core/flight.hpp"

namespace alphadot {

/// Rows as people read them: loads and variables in the plane of symmetry, out of it, one by the other, by
/// controls; `other` is what has no place among these.
enum class Group { longitudinal, lateral, cross, controls, other };

/// The part of an uncertainty that is there where the symmetry of a flow makes a derivative zero.
inline constexpr std::string_view symmetry_part = "symmetry";

/// Of a coefficient, in their order, by a variable.
Group group_of(int coefficient, Variable variable);

/// One line of a table.
struct TableRow {
  std::string name;  ///< as in result.json, "Cm_alphadot"
  Estimate value;
  std::string method;                                    ///< "plunge, k = 0.01", "linear solve", ...
  std::vector<std::pair<std::string, Real>> parts = {};  ///< of the uncertainty, by source; may be empty
  bool converged = true;  ///< everything that it rests on reached what was asked for
  Group group = Group::other;

  /// One that symmetry may make zero, and not told from zero by its uncertainty.
  bool is_zero() const;
};

/// What the uncertainties of rows hold: the mesh's part only when it is one of the parts.
inline constexpr std::string_view solver_only = "solver only; mesh not assessed";
/// solver_only or nothing, by the parts of the rows.
std::string uncertainty_scope(std::span<const TableRow> rows);

/// What a table's numbers refer to and how far to be trusted.
struct TableHead {
  ReferenceSettings reference;
  std::string status = "";       ///< of the run, and what was not reached; empty: not known
  std::string uncertainty = "";  ///< its scope; empty: not known
  std::string origin = "";       ///< flow, mesh and program; empty: not known
};

/// A row for each entry of the set, by groups, column by column; what symmetry makes exactly zero is left
/// out. The parts are those that the uncertainties of the set are the sums of, in all of its columns; columns
/// of `unconverged` variables are marked.
std::vector<TableRow> rows_of(const DerivativeSet& derivatives, const std::string& method,
                              Axes axes = Axes::body, std::span<const UncertaintyPart> parts = {},
                              const std::set<Variable>& unconverged = {});

/// What every number refers to: reference length and area, moment centre, axes, normalisation of rates;
/// origin, status and scope of the uncertainties where they are known.
std::string head_text(const TableHead& head, Axes axes = Axes::body);

/// Aligned lines "name value ± uncertainty method" below the head, with a column for each part of the
/// uncertainty, the same in all rows. The column of uncertainties that leave the mesh out is called "solver
/// only"; a row that is not converged says so. By groups, where there are several; rows that are zero within
/// their uncertainty are named below, once.
std::string derivative_table(std::span<const TableRow> rows, const TableHead& head, Axes axes = Axes::body);

/// The same as comma-separated values: comment lines with the head, a header, full precision; "converged"
/// (yes or no), the group and the parts behind the method. All rows; the head names those that are zero
/// within their uncertainty.
std::string derivative_csv(std::span<const TableRow> rows, const TableHead& head, Axes axes = Axes::body);

}  // namespace alphadot
