#include "solver/forces.hpp"

namespace alphadot {

std::vector<Load> wall_loads(const Discretization& discretization, const Residual<Real>& residual,
                             const FlowField<Real>& flow, int order, const Vec3& center) {
  const Subdomain& domain = discretization.domain();
  const Real free_stream_pressure = 1 / discretization.gamma();
  std::vector<Load> loads(domain.patch_names.size());
  for (std::size_t i = 0; i < domain.boundary_faces.size(); ++i) {
    const auto& face = domain.boundary_faces[i];
    if (discretization.kind_of(face) != BoundaryKind::wall) continue;
    const Vec3 at = domain.boundary_center[i];
    const Real pressure = residual.face_state(flow, face.cell, at, order)[4];
    const Vec3 force = (pressure - free_stream_pressure) * domain.boundary_normal[i];
    loads[face.patch].force += force;
    loads[face.patch].moment += cross(at - center, force);
  }
  return loads;
}

}  // namespace alphadot
