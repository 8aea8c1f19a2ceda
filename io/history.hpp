// The record of a run: named columns of numbers, one row a step, with all that an extraction of derivatives
// needs.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "io/hdf5.hpp"
#include "io/provenance.hpp"
#include "motion/settings.hpp"

namespace alphadot {

/// What the numbers of a history refer to.
struct HistoryInfo {
  std::string title;
  ReferenceSettings reference;
  FreestreamSettings freestream;
  MotionSettings motion;
  std::string mesh_file, mesh_hash;
  std::string motion_table_hash;  ///< of the table's content; empty: there is none
  std::string version;            ///< of the program that wrote it
  std::string case_text;          ///< the resolved case
  std::string status;             ///< how the run ended, and what was not reached; empty: not known
  /// How to read the columns.
  std::string conventions =
      "mesh axes x aft, y starboard, z up; CA CY CN along them over q S; Cl Cm Cn over q S length about body "
      "axes x forward, y starboard, z down (nose up, nose to starboard positive); angles in rad; t_star = 2 "
      "V t / "
      "length; rates times length / (2 V); x y z is the way of the centre of gravity over length, e0 e1 e2 "
      "e3 the "
      "quaternion from the axes at rest to those of the body, energy and work are over q S length";

  Origin origin() const { return {freestream, mesh_file, mesh_hash, version}; }
};

/// Columns by convention: step, time, t_star, alpha, theta, q, inner_iterations, inner_residual, and for each
/// component (total, body, fins ...) total/CA total/CY total/CN total/Cl total/Cm total/Cn. In a file the
/// part before the slash is a group.
class History {
 public:
  using Row = std::vector<std::pair<std::string, Real>>;

  History() = default;
  explicit History(HistoryInfo info_of_run) : info(std::move(info_of_run)) {}

  /// Adds one step. The first row sets the columns; later ones must have the same names in the same order
  /// (std::logic_error).
  void append(const Row& row);

  std::size_t steps() const { return columns_.empty() ? 0 : columns_.front().size(); }
  const std::vector<std::string>& names() const { return names_; }
  bool has(const std::string& name) const;
  /// [steps] of one column. Throws InputError naming the columns there are.
  const std::vector<Real>& column(const std::string& name) const;
  /// Groups with loads, in the order of their columns: "total", "body", ...
  std::vector<std::string> components() const;

  /// The history as content of an empty group: of its own file or of a checkpoint.
  void write(hdf5::Group& group) const;
  /// Reads back such a group. Throws InputError when it is not one, of another version, or damaged.
  static History read(const hdf5::Group& group);

  /// Comments with origin and status (if known), a line of names, then a line a step, all digits; empty when
  /// there are none.
  std::string csv() const;
  std::string csv_row(std::size_t step) const;

  HistoryInfo info;

 private:
  std::vector<std::string> names_;
  std::vector<std::vector<Real>> columns_;  // [names][steps]
};

/// Whether a component of that name would share columns with others of a run's history.
bool is_reserved_component(const std::string& name);

/// Writes history.h5 and history.csv into `folder`, each through a temporary file. For one rank; throws
/// InputError.
void write_history(const std::string& folder, const History& history);

/// Reads a history.h5. Throws InputError with what is wrong with the file.
History read_history(const std::string& path);

}  // namespace alphadot
