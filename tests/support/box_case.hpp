// A box mesh cut over the ranks of a communicator, with boundary conditions and flows for the solver's tests.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "space/conditions.hpp"
#include "space/discretization.hpp"
#include "space/flow_field.hpp"
#include "support/box_mesh.hpp"

namespace alphadot::testing_support {

inline constexpr Real gamma_air = 1.4;
inline constexpr FluxKind all_fluxes[] = {FluxKind::roe, FluxKind::van_leer, FluxKind::hllc};

inline std::string name_of(FluxKind kind) {
  return kind == FluxKind::roe ? "roe" : kind == FluxKind::hllc ? "hllc" : "van_leer";
}

/// Treatment of x_min, x_max, y_min, y_max, z_min, z_max.
using BoxSides = std::array<BoundaryKind, 6>;

inline BoxSides open_box() {
  BoxSides sides;
  sides.fill(BoundaryKind::farfield);
  return sides;
}
/// Open along x, walls around.
inline BoxSides channel() {
  BoxSides sides = open_box();
  for (int side = 2; side < 6; ++side) sides[side] = BoundaryKind::wall;
  return sides;
}

/// A perturbed box of unequal sides: 6 * 5 * 4 * 4 cells.
inline Mesh small_box() {
  return box_mesh({.cells = {5, 4, 4}, .lower = {-1, 0, 2}, .upper = {1, 1.2, 3}, .perturbation = 0.12});
}

/// Whether some cells are dissipative: every seventh by its id, ghosts too.
enum class Dissipative { none, some };

/// One rank's share of `mesh` with its discretisation. Stays where it is: the discretisation refers to the
/// domain.
struct BoxCase {
  BoxCase(const Mesh& mesh, const BoxSides& sides, const SpaceSettings& space,
          const Communicator& communicator, Dissipative cells = Dissipative::none)
      : comm(communicator),
        domain(distribute(mesh, comm)),
        discretization(domain, {sides.begin(), sides.end()}, space, gamma_air) {
    if (cells == Dissipative::none) return;
    std::vector<std::uint8_t> marks;
    for (const GlobalIndex id : domain.cell_ids) marks.push_back(id % 7 == 0 ? 1 : 0);
    discretization.set_dissipative(std::move(marks));
  }
  BoxCase(const BoxCase&) = delete;
  BoxCase& operator=(const BoxCase&) = delete;

  std::size_t cells() const { return static_cast<std::size_t>(domain.owned_cells); }

  const Communicator comm;
  const Subdomain domain;
  Discretization discretization;
};

/// A smooth flow without symmetry, about Mach 1.5 along x; density and pressure within a fifth of the free
/// stream.
inline Primitive<Real> wavy_state(const Vec3& x) {
  const Real s = std::sin(2 * x.x + x.y - 0.5 * x.z), c = std::cos(x.x - 1.5 * x.y + 2 * x.z);
  return {{1 + 0.1 * s + 0.05 * c, 1.5 + 0.2 * c, 0.1 + 0.2 * s, -0.2 + 0.1 * s * c,
           (1 - 0.1 * c + 0.05 * s) / gamma_air}};
}

/// The same with jumps of a few per cent from cell to cell, the same on every partition.
inline Primitive<Real> rough_state(const Vec3& x, GlobalIndex id) {
  Primitive<Real> w = wavy_state(x);
  for (int i = 0; i < 5; ++i) w[i] += 0.03 * std::sin(17.0 * static_cast<Real>(id) + 5 * i);
  return w;
}

/// Owned cells from a function of centroid and global id; ghosts are left to the exchange.
template <class State>
void fill(FlowField<Real>& flow, const Subdomain& domain, State&& state) {
  for (Index cell = 0; cell < domain.owned_cells; ++cell)
    flow[cell] = state(domain.center[cell], domain.cell_ids[cell]);
}

/// Values of the owned cells of all ranks by global cell id, on every rank.
inline std::vector<Five<Real>> by_cell_id(const Subdomain& domain, const Communicator& comm,
                                          std::span<const Five<Real>> owned) {
  std::vector<Real> all(5 * static_cast<std::size_t>(domain.global_cells), 0);
  for (Index cell = 0; cell < domain.owned_cells; ++cell)
    for (int i = 0; i < 5; ++i) all[5 * static_cast<std::size_t>(domain.cell_ids[cell]) + i] = owned[cell][i];
  comm.sum(all);
  std::vector<Five<Real>> out(static_cast<std::size_t>(domain.global_cells));
  for (std::size_t k = 0; k < all.size(); ++k) out[k / 5][static_cast<int>(k % 5)] = all[k];
  return out;
}

/// Sum over the owned cells of all ranks.
inline Five<Real> total(const Subdomain& domain, const Communicator& comm,
                        std::span<const Five<Real>> owned) {
  Five<Real> sum;
  for (Index cell = 0; cell < domain.owned_cells; ++cell) sum += owned[cell];
  comm.sum(std::span<Real>(sum.v));
  return sum;
}

/// A grid that translates and turns about a point off the mesh.
inline GridMotion<Real> tumbling_grid() {
  return {{0.3, -0.2, 0.1}, {0.2, 0.5, -0.3}, {0.4, -0.6, 0.2}};
}

}  // namespace alphadot::testing_support
