// A smooth curve through given points.
#pragma once

#include <vector>

#include "core/types.hpp"

namespace alphadot {

/// Cubic Hermite interpolation with the slopes of the parabolas through three neighbouring points: third
/// order, continuous rate. Level before the first point and after the last.
class Curve {
 public:
  Curve() = default;
  /// At least two points, `x` increasing.
  Curve(std::vector<Real> x, std::vector<Real> y);

  Real value(Real x) const;
  Real rate(Real x) const;

 private:
  /// The piece that holds x, and the share of it that lies before x.
  struct Place {
    std::size_t piece;
    Real width, share;
  };
  Place find(Real x) const;

  std::vector<Real> x_, y_, slope_;
};

}  // namespace alphadot
