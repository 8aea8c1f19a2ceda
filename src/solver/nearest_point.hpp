// The distance to the nearest of many points.
#pragma once

#include <vector>

#include "core/vec3.hpp"

namespace alphadot {

/// A k-d tree: points sorted so that the middle of every range splits it along the range's axis.
class NearestPoint {
 public:
  explicit NearestPoint(std::vector<Vec3> points);

  /// Infinite when there are no points. Visits about log(points) of them.
  Real distance(const Vec3& x) const;

 private:
  void sort(std::size_t begin, std::size_t end, int axis);
  void search(const Vec3& x, std::size_t begin, std::size_t end, int axis, Real& best) const;

  std::vector<Vec3> points_;
};

}  // namespace alphadot
