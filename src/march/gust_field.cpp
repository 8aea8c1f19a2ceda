#include "march/gust_field.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace alphadot {

GustField::GustField(Gust gust, const Discretization& discretization)
    : gust_(std::move(gust)), discretization_(discretization) {}

void GustField::enter(Conditions<Real>& conditions, const Attitude& attitude, const Vec3& travel,
                      Real stream_speed, Real time) {
  const Subdomain& domain = discretization_.domain();
  const GustSettings& settings = gust_.settings();
  const auto& grid = conditions.grid;
  const auto cells = static_cast<std::size_t>(domain.owned_cells);
  in_cells_.front = on_turned_axes({1, 0, 0}, attitude.angle);
  in_cells_.direction =
      on_turned_axes(settings.direction == GustDirection::up ? Vec3{0, 0, 1} : Vec3{0, 1, 0}, attitude.angle);
  in_cells_.slope.assign(cells, 0);
  in_cells_.divergence.assign(cells, 0);
  const Vec3 &front = in_cells_.front, &direction = in_cells_.direction;
  const Real front_now = settings.front + settings.speed * stream_speed * time - grid.axis.x - travel.x;

  const auto mean_over = [&](const Vec3& center, const std::array<Index, 3>& points) {
    Real squares = 0;
    for (const Index point : points) {
      const Real way = dot(domain.points[static_cast<std::size_t>(point)] - center, front);
      squares += way * way;
    }
    return gust_.mean(front_now - dot(center - grid.axis, front), 0.5 * std::sqrt(squares));
  };
  const auto add = [&](Index cell, Real strength, const Vec3& outward_area) {
    if (cell >= domain.owned_cells) return;
    in_cells_.slope[static_cast<std::size_t>(cell)] += strength * dot(outward_area, front);
    in_cells_.divergence[static_cast<std::size_t>(cell)] += strength * dot(outward_area, direction);
  };
  speeds_.interior.resize(domain.faces.size());
  for (std::size_t face = 0; face < domain.faces.size(); ++face) {
    const Vec3 &area = domain.face_normal[face], &center = domain.face_center[face];
    const Real strength = mean_over(center, domain.face_points[face]);
    speeds_.interior[face] = dot(grid.at(center) - strength * direction, area) / norm(area);
    add(domain.faces[face].left, strength, area);
    add(domain.faces[face].right, strength, -area);
  }
  speeds_.boundary.resize(domain.boundary_faces.size());
  for (std::size_t face = 0; face < domain.boundary_faces.size(); ++face) {
    const Vec3 &area = domain.boundary_normal[face], &center = domain.boundary_center[face];
    const Real strength = mean_over(center, domain.boundary_faces[face].points);
    speeds_.boundary[face] = dot(grid.at(center) - strength * direction, area) / norm(area);
    add(domain.boundary_faces[face].cell, strength, area);
  }
  conditions.face_speeds = &speeds_;
  conditions.gust = &in_cells_;
}

}  // namespace alphadot
