#include "space/wave_speed.hpp"

#include "space/face_geometry.hpp"

namespace alphadot {

std::vector<Real> wave_speeds(const Discretization& discretization, const FlowField<Real>& flow,
                              const Conditions<Real>& conditions) {
  const Subdomain& domain = discretization.domain();
  const Real gamma = discretization.gamma();
  std::vector<Real> out(static_cast<std::size_t>(domain.owned_cells), 0);
  for (std::size_t face = 0; face < domain.faces.size(); ++face) {
    const auto [left, right] = domain.faces[face];
    const auto [area, normal, center] = interior_geometry(domain, face);
    const Real speed = conditions.face_speed(static_cast<Index>(face), center, normal);
    const Real wave = area * spectral_radius(Real{0.5} * (flow[left] + flow[right]), normal, speed, gamma);
    out[static_cast<std::size_t>(left)] += wave;
    if (right < domain.owned_cells) out[static_cast<std::size_t>(right)] += wave;
  }
  for (std::size_t i = 0; i < domain.boundary_faces.size(); ++i) {
    const Index cell = domain.boundary_faces[i].cell;
    const auto [area, normal, center] = boundary_geometry(domain, i);
    const Real speed = conditions.boundary_speed(i, center, normal);
    out[static_cast<std::size_t>(cell)] += area * spectral_radius(flow[cell], normal, speed, gamma);
  }
  return out;
}

}  // namespace alphadot
