// A motion given point by point in a text file.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "core/vec3.hpp"
#include "motion/curve.hpp"

namespace alphadot {

/// Columns of a motion over t* = 2 V t / length. Absent ones stay at rest.
struct MotionTable {
  Real end = 0;                      ///< t* of the last row; the first is at zero
  std::optional<Curve> alpha;        ///< rad, incidence of the relative wind; excludes a position
  std::optional<Curve> theta;        ///< rad, nose up, as a change from the attitude of the mesh
  std::optional<Curve> position[3];  ///< of the axis point along x, y, z of the mesh, in units of [reference]

  bool has_position() const { return position[0] || position[1] || position[2]; }
};

/// Reads a table: a line of column names (t_star, alpha, theta, x, y, z; angles in degrees), then one line a
/// point. Columns are separated by blanks or commas, # starts a remark. t_star starts at 0 and increases.
/// Throws InputError with `file` and line for anything else.
MotionTable parse_motion_table(std::string_view text, const std::string& file);

}  // namespace alphadot
