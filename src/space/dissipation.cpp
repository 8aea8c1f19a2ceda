#include "space/dissipation.hpp"

#include "space/face_geometry.hpp"

namespace alphadot {

std::vector<Conserved<Real>> dissipation(const Discretization& discretization, const FlowField<Real>& flow,
                                         const Reconstruction<Real>& reconstruction,
                                         const Conditions<Real>& conditions) {
  const Subdomain& domain = discretization.domain();
  std::vector<Conserved<Real>> out(domain.faces.size());
  for (std::size_t face = 0; face < out.size(); ++face) {
    const auto at = static_cast<Index>(face);
    const FluxModel& model = discretization.flux_of(at);
    const auto [area, normal, center] = interior_geometry(domain, face);
    const auto [left, right, scaling] =
        face_states(domain, flow, reconstruction, at, discretization.space().order);
    const Real speed = conditions.face_speed(at, center, normal);
    const auto mean = 0.5 * (physical_flux(left, normal, speed, model.gamma) +
                             physical_flux(right, normal, speed, model.gamma));
    out[face] = area * (numerical_flux(model, left, right, normal, speed) - mean);
  }
  return out;
}

}  // namespace alphadot
