// What a functional is sensitive to on the walls: their points, summed over ranks.
#pragma once

#include <span>
#include <vector>

#include "core/communicator.hpp"
#include "space/discretization.hpp"

namespace alphadot {

/// Of a functional J, on the walls and stings of a mesh.
class SurfaceSensitivity {
 public:
  struct Point {
    GlobalIndex id;  ///< in the mesh file
    Vec3 position;
    Vec3 derivative;  ///< dJ / dposition, the points inside held
  };

  /// From every rank's part of dJ/dX, [points]. Collective; throws InputError where a rank has too many
  /// points to exchange.
  SurfaceSensitivity(const Discretization& discretization, const Communicator& comm,
                     std::span<const Vec3> by_points);

  /// Of the whole mesh by ascending id, on the root alone.
  std::span<const Point> points() const { return points_; }
  /// [boundary_faces] dJ per displacement and area: the mean over the corners of a face of their derivative
  /// by the area of walls around them. Zero where there is no wall.
  std::span<const Vec3> density() const { return density_; }

 private:
  std::vector<Point> points_;
  std::vector<Vec3> density_;
};

}  // namespace alphadot
