#include "space/discretization.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace alphadot {

Discretization::Discretization(const Subdomain& domain, std::vector<BoundaryKind> patch_kinds,
                               const SpaceSettings& space, Real gamma)
    : domain_(domain),
      patch_kinds_(std::move(patch_kinds)),
      space_(space),
      flux_{space.flux, gamma, space.entropy_fix},
      dissipative_flux_{FluxKind::van_leer, gamma, space.entropy_fix} {
  if (patch_kinds_.size() != domain.patch_names.size())
    throw std::logic_error("every patch needs a boundary condition");
  update_geometry();
}

namespace {

/// Of the unit weight of a cell in the value of a point.
constexpr Real largest_correction = 0.8;

}  // namespace

void Discretization::update_geometry() {
  const auto points = static_cast<std::size_t>(domain_.owned_points);
  const auto cells = static_cast<std::size_t>(domain_.owned_cells);
  point_moments_.assign(points, {});
  for (Index point = 0; point < domain_.owned_points; ++point) {
    auto& moments = point_moments_[point];
    Symmetric3 second{};
    for (const Index cell : domain_.point_cells[point]) {
      const Vec3 d = domain_.center[cell] - domain_.points[point];
      moments.count += 1;
      moments.first += d;
      add_square(second, d);
    }
    // Where few cells do not span space (a corner), their plain mean must do.
    const Vec3 lambda = -(inverse(second) * moments.first);
    if (moments.count < 4 || !std::isfinite(norm(lambda))) continue;
    moments.lambda = lambda;
    // On the boundary, where the cells lie to one side, weights are kept well above zero.
    Real largest = 0;
    for (const Index cell : domain_.point_cells[point])
      largest =
          std::max(largest, std::abs(dot(moments.lambda, domain_.center[cell] - domain_.points[point])));
    if (largest > largest_correction) moments.lambda = (largest_correction / largest) * moments.lambda;
  }

  std::vector<std::uint8_t> impermeable_faces(cells, 0);
  for (const auto& face : domain_.boundary_faces)
    if (is_impermeable(kind_of(face))) ++impermeable_faces[face.cell];

  inverse_fit_.assign(cells, {});
  for (Index cell = 0; cell < domain_.owned_cells; ++cell) {
    if (impermeable_faces[cell] >= 2 || (has_dissipative_cells() && dissipative_[cell] != 0)) continue;
    Symmetric3 normal_matrix{};
    for (const Index point : domain_.cell_points[cell])
      for (const Index other : domain_.point_cells[point])
        add_square(normal_matrix, domain_.center[other] - domain_.center[cell]);
    inverse_fit_[cell] = inverse(normal_matrix);
  }
}

void Discretization::set_dissipative(std::vector<std::uint8_t> cells) {
  dissipative_ = std::move(cells);
  update_geometry();
}

std::size_t Discretization::bytes() const {
  return turned_walls_.size() * sizeof(TurnedWall) + dissipative_.size() +
         point_moments_.size() * sizeof(PointMoments) + inverse_fit_.size() * sizeof(Symmetric3);
}

}  // namespace alphadot
