#include "space/dissipation.hpp"

#include <algorithm>

#include "space/face_geometry.hpp"

namespace alphadot {

std::vector<Conserved<Real>> dissipation(const Discretization& discretization, const FlowField<Real>& flow,
                                         const Reconstruction<Real>& reconstruction,
                                         const Conditions<Real>& conditions) {
  const Subdomain& domain = discretization.domain();
  std::vector<Conserved<Real>> out(domain.faces.size());
  for (std::size_t face = 0; face < out.size(); ++face) {
    const auto [left, right] = domain.faces[face];
    const FluxModel& model = discretization.flux_of(static_cast<Index>(face));
    const auto [area, normal, center] = interior_geometry(domain, face);
    Primitive<Real> wl = flow[left], wr = flow[right];
    if (discretization.space().order > 1) {
      const auto l = extrapolated(wl, reconstruction[left], center - domain.center[left]);
      const auto r = extrapolated(wr, reconstruction[right], center - domain.center[right]);
      const Real scaling = std::min(positivity_scaling(l, wl), positivity_scaling(r, wr));
      wl += scaling * (l - wl);
      wr += scaling * (r - wr);
    }
    const Real speed = conditions.face_speed(static_cast<Index>(face), center, normal);
    const auto mean =
        0.5 * (physical_flux(wl, normal, speed, model.gamma) + physical_flux(wr, normal, speed, model.gamma));
    out[face] = area * (numerical_flux(model, wl, wr, normal, speed) - mean);
  }
  return out;
}

}  // namespace alphadot
