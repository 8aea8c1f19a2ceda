#include "solver/jacobian.hpp"

#include <algorithm>
#include <vector>

#include "core/dual.hpp"
#include "euler/boundary.hpp"
#include "solver/wave_speed.hpp"

namespace alphadot {

namespace {

using Matrix = std::array<Real, 25>;  // column by column

/// Adds area * d(flux)/d(state) to `sum`, for the five directions that begin at `first`.
template <int N>
void add_derivative(Matrix& sum, const Conserved<Dual<N>>& flux, int first, Real area) {
  for (int column = 0; column < 5; ++column)
    for (int row = 0; row < 5; ++row) sum[5 * column + row] += area * flux[row].d[first + column];
}

template <int N>
void store_derivative(Block& block, const Conserved<Dual<N>>& flux, int first, Real area) {
  for (int column = 0; column < 5; ++column)
    for (int row = 0; row < 5; ++row)
      block[5 * column + row] = static_cast<float>(area * flux[row].d[first + column]);
}

/// The state with its entries marked as the independent variables first .. first + 4.
template <int N>
Primitive<Dual<N>> independent(const Primitive<Real>& w, int first) {
  Primitive<Dual<N>> out;
  for (int i = 0; i < 5; ++i) {
    out[i].v = w[i];
    out[i].d[first + i] = 1;
  }
  return out;
}

/// Adds scale * dU/dW.
void add_time_term(Matrix& diagonal, const Primitive<Real>& w, Real scale, Real gamma) {
  const Real q2 = w[1] * w[1] + w[2] * w[2] + w[3] * w[3];
  diagonal[0] += scale;
  for (int i = 1; i <= 3; ++i) {
    diagonal[i] += scale * w[i];
    diagonal[5 * i + i] += scale * w[0];
    diagonal[5 * i + 4] += scale * w[0] * w[i];
  }
  diagonal[4] += scale * 0.5 * q2;
  diagonal[24] += scale / (gamma - 1);
}

void face_terms(const Discretization& discretization, const FlowField<Real>& flow,
                const Conditions<Real>& conditions, BlockMatrix& matrix, std::vector<Matrix>& diagonal,
                std::vector<Real>& wave_speed) {
  const Subdomain& domain = discretization.domain();
  const Real gamma = discretization.gamma();
  for (Index face = 0; face < static_cast<Index>(domain.faces.size()); ++face) {
    const auto [left, right] = domain.faces[face];
    const Real area = norm(domain.face_normal[face]);
    const Vec3 normal = (1 / area) * domain.face_normal[face];
    const Real speed = conditions.face_speed(face, domain.face_center[face], normal);
    const auto flux = numerical_flux(discretization.flux(), independent<10>(flow[left], 0),
                                     independent<10>(flow[right], 5), normal, Dual<10>(speed));
    add_derivative(diagonal[left], flux, 0, area);
    store_derivative(matrix.right_of(face), flux, 5, area);
    const auto mean = Real{0.5} * (flow[left] + flow[right]);
    const Real wave = area * spectral_radius(mean, normal, speed, gamma);
    wave_speed[left] += wave;
    if (right >= domain.owned_cells) continue;
    add_derivative(diagonal[right], flux, 5, -area);
    store_derivative(matrix.left_of(face), flux, 0, -area);
    wave_speed[right] += wave;
  }
}

void boundary_terms(const Discretization& discretization, const FlowField<Real>& flow,
                    const Conditions<Real>& conditions, std::vector<Matrix>& diagonal,
                    std::vector<Real>& wave_speed) {
  const Subdomain& domain = discretization.domain();
  const Real gamma = discretization.gamma();
  Primitive<Dual<5>> outside;
  for (int i = 0; i < 5; ++i) outside[i] = conditions.free_stream[i];
  for (std::size_t i = 0; i < domain.boundary_faces.size(); ++i) {
    const auto& face = domain.boundary_faces[i];
    const Real area = norm(domain.boundary_normal[i]);
    const Vec3 normal = (1 / area) * domain.boundary_normal[i];
    const Real speed = conditions.boundary_speed(i, domain.boundary_center[i], normal);
    const auto inside = independent<5>(flow[face.cell], 0);
    const auto flux = is_impermeable(discretization.kind_of(face))
                          ? wall_flux(inside[4], normal, Dual<5>(speed))
                          : far_field_flux(inside, outside, normal, Dual<5>(speed), gamma);
    add_derivative(diagonal[face.cell], flux, 0, area);
    wave_speed[face.cell] += area * spectral_radius(flow[face.cell], normal, speed, gamma);
  }
}

}  // namespace

void assemble_jacobian(const Discretization& discretization, const FlowField<Real>& flow,
                       const Conditions<Real>& conditions, const TimeTerms& time, BlockMatrix& matrix) {
  const Subdomain& domain = discretization.domain();
  const auto cells = static_cast<std::size_t>(domain.owned_cells);
  std::vector<Matrix> diagonal(cells, Matrix{});
  std::vector<Real> wave_speed(cells, 0);
  face_terms(discretization, flow, conditions, matrix, diagonal, wave_speed);
  boundary_terms(discretization, flow, conditions, diagonal, wave_speed);
  for (Index cell = 0; cell < domain.owned_cells; ++cell) {
    const Real scale = wave_speed[cell] / time.cfl + domain.volume[cell] * time.inverse_step;
    add_time_term(diagonal[cell], flow[cell], scale, discretization.gamma());
    const Matrix inverted = inverse(diagonal[cell]);
    std::transform(inverted.begin(), inverted.end(), matrix.inverse_diagonal(cell).begin(),
                   [](Real x) { return static_cast<float>(x); });
  }
}

}  // namespace alphadot
