#include "bench/flops.hpp"

#include <vector>

#include "euler/boundary.hpp"
#include "euler/flux.hpp"
#include "space/face_geometry.hpp"
// The template, to be compiled once more for the number that counts.
#include "space/reconstruction.cpp"  // NOLINT

namespace alphadot {

namespace {

Primitive<Counted> constant(const Primitive<Real>& w) {
  return {{w[0], w[1], w[2], w[3], w[4]}};
}

}  // namespace

Operations residual_operations(const Discretization& discretization, const Communicator& comm,
                               const FlowField<Real>& flow, const Conditions<Real>& conditions) {
  const Subdomain& domain = discretization.domain();
  FlowField<Counted> counted(domain, comm);
  for (Index cell = 0; cell < domain.owned_cells; ++cell) counted[cell] = constant(flow[cell]);
  const auto stream = constant(conditions.free_stream);
  std::vector<Conserved<Counted>> values(static_cast<std::size_t>(domain.owned_cells));
  Reconstruction<Counted> reconstruction(discretization, comm);
  Counted::operations = {};
  reconstruction.update(counted, 2);
  for (std::size_t i = 0; i < domain.faces.size(); ++i) {
    const auto face = static_cast<Index>(i);
    const auto [area, normal, center] = interior_geometry(domain, i);
    const auto [left, right, scaling] = face_states(domain, counted, reconstruction, face, 2);
    const auto flux = area * numerical_flux(discretization.flux_of(face), left, right, normal,
                                            Counted(conditions.face_speed(face, center, normal)));
    values[static_cast<std::size_t>(domain.faces[face].left)] += flux;
    if (const Index neighbour = domain.faces[face].right; neighbour < domain.owned_cells)
      values[static_cast<std::size_t>(neighbour)] -= flux;
  }
  for (std::size_t i = 0; i < domain.boundary_faces.size(); ++i) {
    const auto& face = domain.boundary_faces[i];
    const auto [area, normal, center] = boundary_geometry(domain, i);
    const auto inside = inner_state(domain, counted, reconstruction, i, 2).inside;
    const Counted speed = conditions.boundary_speed(i, center, normal);
    const BoundaryKind kind = discretization.kind_of(face);
    const auto pressure = boundary_pressure(kind, inside, normal, speed, discretization.gamma());
    values[static_cast<std::size_t>(face.cell)] +=
        area * boundary_flux(kind, inside, pressure, stream, normal, speed, discretization.gamma());
  }
  return Counted::operations;
}

}  // namespace alphadot
