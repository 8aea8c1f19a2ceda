#include "solver/deformation.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/error.hpp"
#include "partition/geometry.hpp"
#include "solver/nearest_point.hpp"

namespace alphadot {

namespace {

/// Points of the boundary faces that `wanted` holds for, of all ranks.
template <class Wanted>
std::vector<Vec3> boundary_points(const Subdomain& domain, const Communicator& comm, Wanted&& wanted) {
  std::vector<Index> own;
  for (const auto& face : domain.boundary_faces)
    if (wanted(face)) own.insert(own.end(), face.points.begin(), face.points.end());
  std::ranges::sort(own);
  own.erase(std::ranges::unique(own).begin(), own.end());

  // Each rank fills its part of an array of zeros; the sum is the whole.
  std::vector<GlobalIndex> counts(static_cast<std::size_t>(comm.size()), 0);
  counts[static_cast<std::size_t>(comm.rank())] = static_cast<GlobalIndex>(own.size());
  comm.sum(std::span<GlobalIndex>(counts));
  std::size_t begin = 0, total = 0;
  for (int rank = 0; rank < comm.size(); ++rank) {
    if (rank == comm.rank()) begin = total;
    total += static_cast<std::size_t>(counts[static_cast<std::size_t>(rank)]);
  }
  std::vector<Real> buffer(3 * total, 0);
  for (std::size_t i = 0; i < own.size(); ++i)
    for (int axis = 0; axis < 3; ++axis)
      buffer[3 * (begin + i) + static_cast<std::size_t>(axis)] = domain.points[own[i]][axis];
  comm.sum(std::span<Real>(buffer));
  std::vector<Vec3> out(total);
  for (std::size_t i = 0; i < total; ++i) out[i] = {buffer[3 * i], buffer[3 * i + 1], buffer[3 * i + 2]};
  return out;
}

/// 1 below a tenth of the way, 0 above nine tenths, a polynomial with two continuous derivatives between.
Real blend(Real way) {
  const Real s = std::clamp((way - 0.1) / 0.8, Real{0}, Real{1});
  return 1 - s * s * s * (10 - s * (15 - 6 * s));
}

}  // namespace

std::vector<Real> follow_shares(const Subdomain& domain, const Discretization& discretization,
                                const Communicator& comm) {
  const NearestPoint body(boundary_points(domain, comm, [&](const BoundaryFace& face) {
    const auto kind = discretization.kind_of(face);
    return kind == BoundaryKind::wall || kind == BoundaryKind::sting || kind == BoundaryKind::jet;
  }));
  const NearestPoint far(boundary_points(domain, comm, [&](const BoundaryFace& face) {
    return discretization.kind_of(face) == BoundaryKind::farfield;
  }));
  std::vector<Real> out(domain.points.size());
  for (std::size_t point = 0; point < out.size(); ++point) {
    const Real to_body = body.distance(domain.points[point]), to_far = far.distance(domain.points[point]);
    // Without a body everything rests, without a far field everything moves; where they meet it rests.
    const Real way = to_far == 0 || std::isinf(to_body) ? 1
                     : std::isinf(to_far)               ? 0
                                                        : to_body / (to_body + to_far);
    out[point] = blend(way);
  }
  return out;
}

Real swept_volume(const std::array<Vec3, 3>& from, const std::array<Vec3, 3>& to) {
  const auto area = [](const Vec3& a, const Vec3& b, const Vec3& c) { return 0.5 * cross(b - a, c - a); };
  std::array<Vec3, 3> middle;
  Vec3 path;
  for (std::size_t i = 0; i < 3; ++i) {
    middle[i] = 0.5 * (from[i] + to[i]);
    path += 1.0 / 3 * (to[i] - from[i]);
  }
  // The area vector is quadratic in time: Simpson's rule is exact.
  return dot(path, 1.0 / 6 *
                       (area(from[0], from[1], from[2]) + 4.0 * area(middle[0], middle[1], middle[2]) +
                        area(to[0], to[1], to[2])));
}

DeformingGrid::DeformingGrid(const Motion& motion, const Vec3& axis_point, Real time_step, Subdomain& domain,
                             Discretization& discretization, const Communicator& comm)
    : MovingGrid(motion, axis_point, time_step, domain, discretization),
      comm_(comm),
      share_(follow_shares(domain, discretization, comm)),
      volumes_{domain.volume, domain.volume, domain.volume},
      speeds_{std::vector<Real>(domain.faces.size()), std::vector<Real>(domain.boundary_faces.size())} {}

std::vector<Vec3> DeformingGrid::points_at(int step) const {
  const BodyPlace body = place(step);
  std::vector<Vec3> out(rest_.size());
  for (std::size_t point = 0; point < out.size(); ++point)
    out[point] = rest_[point] + share_[point] * (body.carried(rest_[point]) - rest_[point]);
  return out;
}

void DeformingGrid::find_speeds(int step, const std::array<std::vector<Vec3>, 3>& points) {
  const TimeWeights weight = time_weights(step, time_step_);
  const auto corners = [&](int level, const std::array<Index, 3>& face) {
    const auto& at = points[static_cast<std::size_t>(level)];
    return std::array<Vec3, 3>{at[face[0]], at[face[1]], at[face[2]]};
  };
  const auto speed = [&](const std::array<Index, 3>& face, const Vec3& normal) {
    const Real latest = swept_volume(corners(1, face), corners(0, face)),
               before = swept_volume(corners(2, face), corners(1, face));
    return (weight.now * latest - weight.older * before) / norm(normal);
  };
  for (std::size_t face = 0; face < domain_.faces.size(); ++face)
    speeds_.interior[face] = speed(domain_.face_points[face], domain_.face_normal[face]);
  for (std::size_t face = 0; face < domain_.boundary_faces.size(); ++face)
    speeds_.boundary[face] = speed(domain_.boundary_faces[face].points, domain_.boundary_normal[face]);
}

Conditions<Real> DeformingGrid::move_to(int step) {
  std::array<std::vector<Vec3>, 3> points;
  for (int back = 2; back >= 0; --back) {
    const auto level = static_cast<std::size_t>(back);
    points[level] = points_at(step - back);
    domain_.points = points[level];
    domain_.update_metrics();
    volumes_[level] = domain_.volume;
  }
  if (comm_.any(std::ranges::min(domain_.volume) <= 0))
    throw DivergedError(
        "the deforming grid folds: the body moves too far for the room around it; take a "
        "smaller amplitude, a higher frequency, or motion.treatment = \"rigid_grid\"");
  discretization_.update_geometry();
  now_ = place(step);
  find_speeds(step, points);
  const Attitude attitude = motion_.at(step * time_step_);
  return {.free_stream = free_stream(motion_.wind(), discretization_.gamma()),
          .grid = {attitude.velocity, attitude.rotation, axis_point_ + now_.travel},
          .turning_stream = {},
          .turning_source = false,
          .face_speeds = &speeds_};
}

}  // namespace alphadot
