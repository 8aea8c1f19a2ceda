// The shape of a gust: how fast its air moves across the stream, over the distance behind its front.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "motion/settings.hpp"

namespace alphadot {

/// A gust by points, straight between them; level after the last, nothing before the first at zero.
struct GustTable {
  std::vector<Real> distance;  ///< behind the front, increasing from zero, in the unit of [reference]
  std::vector<Real> velocity;  ///< over V
};

/// Reads a table: a line with the names of the columns, distance and velocity, then one line a point. Columns
/// are separated by blanks or commas, # starts a remark. Throws InputError with `file` and line.
GustTable parse_gust_table(std::string_view text, const std::string& file);

class Gust {
 public:
  /// `speed`: V.
  Gust(const GustSettings& settings, Real speed, GustTable table = {});

  const GustSettings& settings() const { return settings_; }
  /// Velocity of the air across the stream at a distance behind the front, in units of V's.
  Real velocity(Real distance) const;
  /// Its mean over distances within `half_width` of one.
  Real mean(Real distance, Real half_width) const;

 private:
  /// The integral of velocity over the distance, from the front on.
  Real integral(Real distance) const;

  GustSettings settings_;
  Real speed_;
  GustTable table_;
  std::vector<Real> integrals_;  // up to the table's points
};

}  // namespace alphadot
