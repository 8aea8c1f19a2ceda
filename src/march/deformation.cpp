#include "march/deformation.hpp"

#include <algorithm>
#include <cmath>

#include "core/error.hpp"
#include "march/blend.hpp"
#include "partition/geometry.hpp"
#include "space/influence.hpp"

namespace alphadot {

namespace {

/// Of the way on which a grid comes to rest: there shocks are smeared.
constexpr Real still_disturbed = 0.1;

}  // namespace

std::vector<Real> follow_shares(const Discretization& discretization, const Vec3& wind,
                                const Communicator& comm) {
  const Influence influence(discretization, wind, comm);
  const auto& points = discretization.domain().points;
  std::vector<Real> out(points.size());
  for (std::size_t point = 0; point < out.size(); ++point) out[point] = influence.distance(points[point]);
  const Real farthest = comm.max(out.empty() ? 0 : std::ranges::max(out));
  const Real reach = std::max(farthest, influence.body_size());
  for (Real& share : out) share = blend((share / reach - still_disturbed) / (1 - still_disturbed));
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
      share_(follow_shares(discretization, motion.wind(), comm)),
      volumes_{domain.volume, domain.volume, domain.volume},
      speeds_{std::vector<Real>(domain.faces.size()), std::vector<Real>(domain.boundary_faces.size())} {}

std::vector<Vec3> DeformingGrid::points_at(int step) {
  const BodyPlace body = place(step);
  std::vector<Vec3> out(rest_.size());
  for (std::size_t point = 0; point < out.size(); ++point)
    out[point] = rest_[point] + share_[point] * (body.carried(rest_[point]) - rest_[point]);
  return out;
}

void DeformingGrid::find_speeds(int step, const std::array<std::vector<Vec3>, 3>& points) {
  const TimeWeights weight = time_weights(step, weights_step_);
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
