#include "linear/lu_sgs.hpp"

#include <algorithm>

#include "core/dual.hpp"
#include "space/face_geometry.hpp"
#include "space/wave_speed.hpp"

namespace alphadot {

LuSgs::LuSgs(const Discretization& discretization, const Communicator& comm)
    : discretization_(discretization),
      face_wave_(discretization.domain().faces.size()),
      diagonal_(static_cast<std::size_t>(discretization.domain().owned_cells)),
      update_(discretization.domain(), comm, HaloWidth::faces) {}

void LuSgs::linearise(const FlowField<Real>& flow, const Conditions<Real>& conditions,
                      const TimeTerms& time) {
  const Subdomain& domain = discretization_.domain();
  const Real gamma = discretization_.gamma();
  flow_ = &flow;
  conditions_ = conditions;
  std::ranges::fill(diagonal_, 0);
  for (std::size_t face = 0; face < domain.faces.size(); ++face) {
    const auto [left, right] = domain.faces[face];
    const auto [area, normal, center] = interior_geometry(domain, face);
    const Real speed = conditions.face_speed(static_cast<Index>(face), center, normal);
    face_wave_[face] = 0.5 * area *
                       std::max(spectral_radius(flow[left], normal, speed, gamma),
                                spectral_radius(flow[right], normal, speed, gamma));
    diagonal_[left] += face_wave_[face];
    if (right < domain.owned_cells) diagonal_[right] += face_wave_[face];
  }
  for (std::size_t i = 0; i < domain.boundary_faces.size(); ++i) {
    const Index cell = domain.boundary_faces[i].cell;
    const auto [area, normal, center] = boundary_geometry(domain, i);
    const Real speed = conditions.boundary_speed(i, center, normal);
    diagonal_[cell] += 0.5 * area * spectral_radius(flow[cell], normal, speed, gamma);
  }
  for (Index cell = 0; cell < domain.owned_cells; ++cell)
    diagonal_[cell] = diagonal_[cell] * (1 + 2 / time.cfl) + domain.volume[cell] * time.inverse_step;
}

Conserved<Real> LuSgs::off_diagonal(Index row) const {
  const Subdomain& domain = discretization_.domain();
  const Real gamma = discretization_.gamma();
  Conserved<Real> sum{};
  for (const Index face : domain.cell_faces[row]) {
    const auto [left, right] = domain.faces[face];
    const Index other = left == row ? right : left;
    const Conserved<Real>& du = update_[other];
    const Vec3& area = domain.face_normal[face];
    const Real half = left == row ? 0.5 : -0.5;
    const Real swept = conditions_.face_sweep(face, domain.face_center[face], area);
    const auto& w = (*flow_)[other];
    const auto dw = primitive_change(w, du, gamma);
    Primitive<Dual<1>> changing;
    for (int i = 0; i < 5; ++i) {
      changing[i] = w[i];
      changing[i].d[0] = dw[i];
    }
    const auto flux = physical_flux(changing, area, Dual<1>(swept), gamma);
    for (int i = 0; i < 5; ++i) sum[i] += half * flux[i].d[0] - face_wave_[face] * du[i];
  }
  return sum;
}

void LuSgs::solve(std::span<const LinearSystem> systems) {
  for (const auto& system : systems) solve_one(system);
}

void LuSgs::solve_one(const LinearSystem& system) {
  const Index cells = discretization_.domain().owned_cells;
  std::ranges::fill(update_.values(), Conserved<Real>{});
  const auto relax = [&](Index row) {
    update_[row] = (-1 / diagonal_[row]) * (system.residual[row] + off_diagonal(row));
  };
  for (Index row = 0; row < cells; ++row) relax(row);
  update_.exchange();
  for (Index row = cells - 1; row >= 0; --row) relax(row);
  for (Index cell = 0; cell < cells; ++cell)
    system.update[cell] = primitive_change((*flow_)[cell], update_[cell], discretization_.gamma());
}

std::size_t LuSgs::bytes() const {
  return (face_wave_.size() + diagonal_.size()) * sizeof(Real) + update_.bytes();
}

}  // namespace alphadot
