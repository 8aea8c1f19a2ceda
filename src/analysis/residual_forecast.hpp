// How long a steady march will still take, where that can be known.
#pragma once

#include <vector>

#include "core/types.hpp"

namespace alphadot {

class ResidualForecast {
 public:
  /// After one more iteration: seconds since some moment, and decades that the residual has dropped.
  void add(Real seconds, Real orders);
  /// Seconds until it has dropped `orders` decades, as fast as in the last twenty iterations. Not a number
  /// while that cannot be known: unless each of their halves gained at least half as much as the other.
  Real seconds_to(Real orders) const;

 private:
  struct Point {
    Real seconds, orders;
  };
  std::vector<Point> points_;  // the latest
};

}  // namespace alphadot
