#include "linear/jacobian.hpp"

#include <algorithm>
#include <vector>

#include "euler/boundary.hpp"
#include "euler/independent.hpp"
#include "euler/state_change.hpp"
#include "space/face_geometry.hpp"
#include "space/turned_walls.hpp"
#include "space/wave_speed.hpp"

namespace alphadot {

namespace {

using Matrix = std::array<Real, 25>;  // column by column

/// Single precision, which the blocks are stored in, has twice the numbers in a register.
using Number = Dual<10, float>;
/// Directions in which the states of a face's cells change.
constexpr int by_left = 0, by_right = 5;

/// Adds area * d(flux)/d(state) to `sum`; the state's five directions begin with `first`.
template <class T>
void add_derivative(Matrix& sum, const Conserved<T>& flux, int first, Real area) {
  for (int column = 0; column < 5; ++column)
    for (int row = 0; row < 5; ++row) sum[5 * column + row] += area * flux[row].d[first + column];
}

template <class T>
void store_derivative(Block& block, const Conserved<T>& flux, int first, Real area) {
  for (int column = 0; column < 5; ++column)
    for (int row = 0; row < 5; ++row)
      block[5 * column + row] = static_cast<float>(area * flux[row].d[first + column]);
}

/// Adds scale * dU/dW.
void add_time_term(Matrix& diagonal, const Primitive<Real>& w, Real scale, Real gamma) {
  for (int column = 0; column < 5; ++column) {
    Primitive<Real> unit;
    unit[column] = 1;
    const auto change = conserved_change(w, unit, gamma);
    for (int row = 0; row < 5; ++row) diagonal[5 * column + row] += scale * change[row];
  }
}

[[gnu::flatten]] void face_terms(const Discretization& discretization, const FlowField<Real>& flow,
                                 const Conditions<Real>& conditions, BlockMatrix& matrix,
                                 std::vector<Matrix>& diagonal) {
  const Subdomain& domain = discretization.domain();
  for (Index face = 0; face < static_cast<Index>(domain.faces.size()); ++face) {
    const auto [left, right] = domain.faces[face];
    const auto [area, normal, center] = interior_geometry(domain, static_cast<std::size_t>(face));
    const Real speed = conditions.face_speed(face, center, normal);
    const auto flux =
        numerical_flux(discretization.flux_of(face), independent<10, float>(flow[left], by_left),
                       independent<10, float>(flow[right], by_right), normal, Number(speed));
    add_derivative(diagonal[left], flux, by_left, area);
    store_derivative(matrix.right_of(face), flux, by_right, area);
    if (right >= domain.owned_cells) continue;
    add_derivative(diagonal[right], flux, by_right, -area);
    store_derivative(matrix.left_of(face), flux, by_left, -area);
  }
}

void boundary_terms(const Discretization& discretization, const FlowField<Real>& flow,
                    const Conditions<Real>& conditions, std::vector<Matrix>& diagonal) {
  const Subdomain& domain = discretization.domain();
  const Real gamma = discretization.gamma();
  const auto outside = constant<5>(conditions.free_stream);
  for (std::size_t i = 0; i < domain.boundary_faces.size(); ++i) {
    const auto& face = domain.boundary_faces[i];
    const auto [area, normal, center] = boundary_geometry(domain, i);
    const Dual<5> speed = conditions.boundary_speed(i, center, normal);
    const auto inside = independent<5>(flow[face.cell]);
    const BoundaryKind kind = discretization.kind_of(face);
    const auto pressure = boundary_pressure(kind, inside, normal, speed, gamma);
    const auto flux = boundary_flux(kind, inside, pressure, outside, normal, speed, gamma);
    add_derivative(diagonal[face.cell], flux, 0, area);
  }
}

/// What walls that have turned change about that.
void turned_terms(const Discretization& discretization, const FlowField<Real>& flow,
                  const Conditions<Real>& conditions, std::vector<Matrix>& diagonal) {
  const Subdomain& domain = discretization.domain();
  const Real gamma = discretization.gamma();
  for (const TurnedWall& wall : discretization.turned_walls()) {
    const auto i = static_cast<std::size_t>(wall.face);
    const Index cell = domain.boundary_faces[i].cell;
    const auto [area, normal, center] = boundary_geometry(domain, i);
    const auto turned = turned_geometry(domain, wall);
    const Dual<5> speed = conditions.boundary_speed(i, center, normal);
    const Dual<5> speed_there = turned_speed(wall, turned, conditions);
    const auto inside = independent<5>(flow[cell]);
    const auto flux = turned_wall_flux(inside, normal, speed, inside, turned.normal, speed_there, gamma).flux;
    add_derivative(diagonal[cell],
                   flux - wall_flux(wall_pressure(inside, normal, speed, gamma), normal, speed), 0, area);
  }
}

}  // namespace

void assemble_jacobian(const Discretization& discretization, const FlowField<Real>& flow,
                       const Conditions<Real>& conditions, const TimeTerms& time, BlockMatrix& matrix) {
  const Subdomain& domain = discretization.domain();
  const auto cells = static_cast<std::size_t>(domain.owned_cells);
  std::vector<Matrix> diagonal(cells, Matrix{});
  const auto wave_speed = wave_speeds(discretization, flow, conditions);
  face_terms(discretization, flow, conditions, matrix, diagonal);
  boundary_terms(discretization, flow, conditions, diagonal);
  turned_terms(discretization, flow, conditions, diagonal);
  for (Index cell = 0; cell < domain.owned_cells; ++cell) {
    const Real scale = wave_speed[cell] / time.cfl + domain.volume[cell] * time.inverse_step;
    add_time_term(diagonal[cell], flow[cell], scale, discretization.gamma());
    const Matrix inverted = inverse(diagonal[cell]);
    std::transform(inverted.begin(), inverted.end(), matrix.inverse_diagonal(cell).begin(),
                   [](Real x) { return static_cast<float>(x); });
  }
}

}  // namespace alphadot
