// The record of a motion that derivatives are taken from.
#pragma once

#include <vector>

#include "analysis/coefficients.hpp"

namespace alphadot {

/// Loads along a motion, one entry a step in every vector.
struct ForceHistory {
  std::vector<Real> time;             ///< t* = 2 V t / l, zero where the motion starts, increasing
  std::vector<Real> angle;            ///< rad, the angle that the motion drives; a step needs none
  std::vector<Coefficients> loads;
  std::vector<Coefficients> bounds;   ///< largest error of `loads` from inner convergence; may be empty

  /// One coefficient along the history; `coefficient` is an index as in coefficient_names.
  std::vector<Real> load(int coefficient) const { return series(loads, coefficient); }
  std::vector<Real> bound(int coefficient) const { return series(bounds, coefficient); }

 private:
  static std::vector<Real> series(const std::vector<Coefficients>& values, int coefficient) {
    std::vector<Real> out;
    out.reserve(values.size());
    for (const auto& value : values) out.push_back(value[coefficient]);
    return out;
  }
};

}  // namespace alphadot
