#include "analysis/low_frequency.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/error.hpp"

namespace alphadot {

namespace {

struct Point {
  Real k;
  Estimate value;
};

/// Lagrange's polynomial in k^2 through the points, at k = 0.
Estimate limit_of(std::span<const Point> points) {
  Estimate sum;
  for (std::size_t i = 0; i < points.size(); ++i) {
    Real weight = 1;
    for (std::size_t j = 0; j < points.size(); ++j) {
      const Real ki = points[i].k, kj = points[j].k;
      if (j != i) weight *= kj * kj / ((kj - ki) * (kj + ki));
    }
    sum += weight * points[i].value;
  }
  return sum;
}

}  // namespace

Estimate low_frequency_limit(std::span<const Real> frequencies, std::span<const Estimate> values) {
  std::vector<Point> points;
  for (std::size_t i = 0; i < std::min(frequencies.size(), values.size()); ++i)
    points.push_back({frequencies[i], values[i]});
  std::ranges::sort(points, {}, &Point::k);
  const bool repeated = std::ranges::adjacent_find(points, {}, &Point::k) != points.end();
  if (frequencies.size() != values.size() || points.size() < 2 || !(points[0].k > 0) || repeated)
    throw InputError("", 0, "low-frequency limit: needs values at two or more different positive frequencies",
                     "compute the motion at another reduced frequency");
  Estimate limit = limit_of(points);
  const Estimate without_last = limit_of(std::span(points).first(points.size() - 1));
  limit.uncertainty += std::abs(limit.value - without_last.value);
  return limit;
}

}  // namespace alphadot
