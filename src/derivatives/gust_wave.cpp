#include "derivatives/gust_wave.hpp"

#include <cmath>
#include <complex>
#include <utility>

namespace alphadot {

namespace {

/// Real or imaginary part of the wave exp(-i phase), as a field velocity on the faces and in the cells.
class WavePart {
 public:
  WavePart(const Linearisation& linearisation, const Vec3& velocity, Real wave_number, const Vec3& origin,
           bool is_imaginary)
      : linearisation_(linearisation),
        velocity_(velocity),
        wave_number_(wave_number),
        origin_(origin),
        is_imaginary_(is_imaginary) {
    const auto cells = static_cast<std::size_t>(linearisation.discretization().domain().owned_cells);
    in_cells_.front = {1, 0, 0};
    in_cells_.direction = (1 / norm(velocity)) * velocity;
    in_cells_.slope.assign(cells, 0);
    in_cells_.divergence.assign(cells, 0);
  }

  std::vector<Conserved<Real>> residual(std::vector<Real>& pressures) {
    const Subdomain& domain = linearisation_.discretization().domain();
    std::vector<Conserved<Real>> out(static_cast<std::size_t>(domain.owned_cells));
    pressures.assign(domain.boundary_faces.size(), 0);
    for (std::size_t face = 0; face < domain.faces.size(); ++face) {
      const auto [left, right] = domain.faces[face];
      const Vec3& area = domain.face_normal[face];
      const Real strength = mean_over(domain.face_center[face], domain.face_points[face]);
      const Real speed = -strength * dot(velocity_, area) / norm(area);
      const Conserved<Real> flux = speed * linearisation_.faces()[face].speed;
      add(left, flux, strength, area, out);
      add(right, Real(-1) * flux, strength, -area, out);
    }
    for (std::size_t i = 0; i < domain.boundary_faces.size(); ++i) {
      const Vec3& area = domain.boundary_normal[i];
      const auto& derivatives = linearisation_.boundary_faces()[i];
      const Real strength = mean_over(domain.boundary_center[i], domain.boundary_faces[i].points);
      const Real speed = -strength * dot(velocity_, area) / norm(area);
      add(domain.boundary_faces[i].cell, speed * derivatives.speed, strength, area, out);
      pressures[i] = speed * derivatives.pressure_by_speed;
    }
    auto conditions = linearisation_.conditions();
    conditions.gust = &in_cells_;
    for (std::size_t cell = 0; cell < out.size(); ++cell)
      out[cell] += gust_source(linearisation_.flow()[static_cast<Index>(cell)], conditions, cell,
                               linearisation_.discretization().gamma());
    return out;
  }

 private:
  Real mean_over(const Vec3& center, const std::array<Index, 3>& points) const {
    Real squares = 0;
    for (const Index point : points) {
      const Real way =
          linearisation_.discretization().domain().points[static_cast<std::size_t>(point)].x - center.x;
      squares += way * way;
    }
    const Real half = wave_number_ * 0.5 * std::sqrt(squares), phase = wave_number_ * (center.x - origin_.x);
    const Real share = half > 1e-4 ? std::sin(half) / half : 1;
    return share * (is_imaginary_ ? -std::sin(phase) : std::cos(phase));
  }
  void add(Index cell, const Conserved<Real>& flux, Real strength, const Vec3& outward_area,
           std::vector<Conserved<Real>>& out) {
    if (std::cmp_greater_equal(cell, out.size())) return;
    const auto at = static_cast<std::size_t>(cell);
    out[at] += flux;
    in_cells_.slope[at] += norm(velocity_) * strength * outward_area.x;
    in_cells_.divergence[at] += strength * dot(outward_area, velocity_);
  }

  const Linearisation& linearisation_;
  Vec3 velocity_;
  Real wave_number_;
  Vec3 origin_;
  bool is_imaginary_;
  GustInCells in_cells_;
};

}  // namespace

OscillatingSource gust_wave(const Linearisation& linearisation, const Vec3& velocity, Real omega,
                            const Vec3& origin) {
  const Real wave_number = omega / linearisation.conditions().free_stream[1];
  OscillatingSource out;
  for (const bool is_imaginary : {false, true}) {
    std::vector<Real> pressures;
    const auto part =
        WavePart(linearisation, velocity, wave_number, origin, is_imaginary).residual(pressures);
    out.residual.insert(out.residual.end(), part.begin(), part.end());
    out.loads[is_imaginary ? 1 : 0] = wall_loads(linearisation.discretization(), pressures, origin);
  }
  return out;
}

}  // namespace alphadot
