#include "motion/motion_table.hpp"

#include <array>
#include <utility>
#include <vector>

#include "core/error.hpp"
#include "motion/column_table.hpp"

namespace alphadot {

MotionTable parse_motion_table(std::string_view text, const std::string& file) {
  constexpr std::array<std::string_view, 6> columns = {"t_star", "alpha", "theta", "x", "y", "z"};
  const ColumnTable table(text, file,
                          {"a motion", columns, "a motion starts at t_star = 0, after the steady state"});
  const auto curve = [&](std::string_view name, Real unit) -> std::optional<Curve> {
    if (!table.has(name)) return std::nullopt;
    std::vector<Real> scaled = table.column(name);
    for (Real& value : scaled) value *= unit;
    return Curve(table.column("t_star"), std::move(scaled));
  };
  MotionTable out;
  out.end = table.column("t_star").back();
  out.alpha = curve("alpha", radians_per_degree);
  out.theta = curve("theta", radians_per_degree);
  out.position[0] = curve("x", 1);
  out.position[1] = curve("y", 1);
  out.position[2] = curve("z", 1);
  if (out.alpha && out.has_position())
    throw InputError(file, 0, "the table gives both alpha and a position, which follow from one another",
                     "leave out either alpha or x, y and z");
  return out;
}

}  // namespace alphadot
