// The record of a motion that derivatives are taken from.
#pragma once

#include <vector>

#include "analysis/coefficients.hpp"

namespace alphadot {

/// Loads along a motion, one entry a step in every vector.
struct ForceHistory {
  std::vector<Real> time;   ///< t* = 2 V t / l, zero where the motion starts, increasing
  std::vector<Real> angle;  ///< rad, the angle that the motion drives; may be empty for a step
  std::vector<Coefficients> loads;
  std::vector<Coefficients> bounds;  ///< largest error of `loads` from inner convergence; may be empty
  Real time_step = 0;  ///< t*, of the march in time that made the loads; 0: they are exact in time

  /// Throws InputError when the vectors differ in length.
  void validate() const;

  /// One coefficient along the history; `coefficient` is an index as in coefficient_names.
  std::vector<Real> load(int coefficient) const;
  std::vector<Real> bound(int coefficient) const;
};

}  // namespace alphadot
