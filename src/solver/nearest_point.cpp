#include "solver/nearest_point.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace alphadot {

NearestPoint::NearestPoint(std::vector<Vec3> points) : points_(std::move(points)) {
  sort(0, points_.size(), 0);
}

void NearestPoint::sort(std::size_t begin, std::size_t end, int axis) {
  if (end - begin < 2) return;
  const std::size_t middle = begin + (end - begin) / 2;
  const auto at = [&](std::size_t i) { return points_.begin() + static_cast<std::ptrdiff_t>(i); };
  std::nth_element(at(begin), at(middle), at(end),
                   [axis](const Vec3& a, const Vec3& b) { return a[axis] < b[axis]; });
  sort(begin, middle, (axis + 1) % 3);
  sort(middle + 1, end, (axis + 1) % 3);
}

void NearestPoint::search(const Vec3& x, std::size_t begin, std::size_t end, int axis, Real& best) const {
  if (begin == end) return;
  const std::size_t middle = begin + (end - begin) / 2;
  const Vec3 away = x - points_[middle];
  best = std::min(best, dot(away, away));
  const int next = (axis + 1) % 3;
  const bool below = away[axis] < 0;
  search(x, below ? begin : middle + 1, below ? middle : end, next, best);
  if (away[axis] * away[axis] < best) search(x, below ? middle + 1 : begin, below ? end : middle, next, best);
}

Real NearestPoint::distance(const Vec3& x) const {
  Real best = std::numeric_limits<Real>::infinity();
  search(x, 0, points_.size(), 0, best);
  return std::sqrt(best);
}

}  // namespace alphadot
