#include "derivatives/adjoint.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "derivatives/block_solve.hpp"
#include "derivatives/mass_term.hpp"
#include "derivatives/remaining_error.hpp"
#include "linear/shape_transpose.hpp"
#include "space/wave_speed.hpp"

namespace alphadot {

namespace {

using Field = std::vector<Five<Real>>;

constexpr std::ptrdiff_t numbers_of_change = 9;

std::vector<Real> numbers_of(const ConditionsChange& change) {
  std::vector<Real> out;
  for (const Vec3& part : {change.wind, change.grid_velocity, change.rotation})
    out.insert(out.end(), {part.x, part.y, part.z});
  return out;
}

ConditionsChange change_of(std::span<const Real> n) {
  return {{n[0], n[1], n[2]}, {n[3], n[4], n[5]}, {n[6], n[7], n[8]}};
}

Real dot_product(std::span<const Five<Real>> a, const CellChanges& b) {
  Five<Real> sum;
  for (const auto& [cell, change] : b)
    for (int i = 0; i < 5; ++i) sum[i] += a[static_cast<std::size_t>(cell)][i] * change[i];
  return sum[0] + sum[1] + sum[2] + sum[3] + sum[4];
}

/// The transpose of the tangent with the problems' sources, as a block solve wants it. Followed are psi . R_c
/// less the load's own part, by the conditions and by whatever else.
template <int N>
class AdjointOperator {
 public:
  static constexpr std::size_t parts = 1;
  static constexpr auto transposed = Transposed::yes;

  AdjointOperator(ImplicitIteration& iteration, const Linearisation& linearisation,
                  std::span<const AdjointProblem> problems, std::span<const CellChanges> residual_changes)
      : iteration_(iteration),
        problems_(problems),
        residual_changes_(residual_changes),
        waves_(wave_speeds(iteration.discretization(), iteration.flow(), linearisation.conditions())),
        transpose_(linearisation, iteration.moment_center()) {}

  void apply(const typename TangentTranspose<N>::Adjoints& fields,
             const typename TangentTranspose<N>::Images& images, bool with_source) {
    std::array<std::vector<Load>, N> minus;
    typename TangentTranspose<N>::Weights weights;
    for (std::size_t k = 0; with_source && k < N; ++k) {
      for (const Load& weight : problems_[k].weights) minus[k].push_back(-1 * weight);
      weights[k] = minus[k];
    }
    transpose_.apply(fields, weights, images);
    const auto by_conditions = transpose_.conditions(weights);
    for (std::size_t k = 0; k < N; ++k) {
      if (with_source && !problems_[k].rate.empty())
        add_transposed_mass_term(iteration_, problems_[k].rate, images[k]);
      for (std::size_t cell = 0; with_source && cell < problems_[k].source.size(); ++cell)
        images[k][cell] += problems_[k].source[cell];
      products_[k] = numbers_of(by_conditions[k]);
      for (const auto& change : residual_changes_) products_[k].push_back(dot_product(fields[k], change));
    }
  }
  std::vector<Real> functionals(std::size_t k) const { return products_[k]; }
  /// By what a defect changes an adjoint while a wave crosses the cell.
  void scale(std::span<const Five<Real>> image, std::span<Five<Real>> out) const {
    for (std::size_t cell = 0; cell < waves_.size(); ++cell) out[cell] = (1 / waves_[cell]) * image[cell];
  }
  void unscale(std::span<const Five<Real>> scaled, std::span<Five<Real>> out) const {
    for (std::size_t cell = 0; cell < waves_.size(); ++cell) out[cell] = waves_[cell] * scaled[cell];
  }

 private:
  ImplicitIteration& iteration_;
  std::span<const AdjointProblem> problems_;
  std::span<const CellChanges> residual_changes_;
  std::vector<Real> waves_;  // [owned_cells] sum over the faces of area times wave speed
  TangentTranspose<N> transpose_;
  std::array<std::vector<Real>, N> products_;
};

/// The largest sensitivity to a velocity, by which that to a rotation about a point of the body is taken to
/// be at least moment_arm of the body's size larger and at most all of it, since symmetry leaves the adjoint
/// of roll none to velocities; and to anything else as large.
std::vector<Real> scales_of(std::span<const Real> products, Real body_size) {
  const auto size = [&](std::size_t begin) {
    return std::hypot(products[begin], products[begin + 1], products[begin + 2]);
  };
  const Real velocity = std::max({size(0), size(3), size(6) / body_size}),
             rotation = std::max(size(6), moment_arm * body_size * velocity);
  std::vector<Real> out(6, velocity);
  out.insert(out.end(), 3, rotation);
  for (std::size_t i = numbers_of_change; i < products.size(); ++i)
    out.push_back(std::max(velocity, std::abs(products[i])));
  return out;
}

Adjoint adjoint_of(const AdjointProblem& problem, Real orders, Field field, BlockRecord record,
                   int iterations, Real body_size, const Communicator& comm) {
  std::vector<Real> all;
  for (const auto& products : record.functionals) all.insert(all.end(), products.begin(), products.end());
  comm.sum(all);
  auto next = all.begin();
  for (auto& products : record.functionals)
    for (Real& product : products) product = *next++;
  std::vector<Real> sensitivity;  // dJ/dc = J_c - psi . R_c
  for (const Real product : record.functionals.back()) sensitivity.push_back(-product);
  const auto scales = scales_of(sensitivity, body_size);
  const auto error = remaining_error(record.norms, record.functionals, scales, record.drop(), orders,
                                     bends + problem.inherited_error);
  return {.name = problem.name,
          .field = std::move(field),
          .sensitivity = change_of(sensitivity),
          .sensitivity_error = change_of(error),
          .products = {sensitivity.begin() + numbers_of_change, sensitivity.end()},
          .products_error = {error.begin() + numbers_of_change, error.end()},
          .relative_error = relative_error(error, scales),
          .relative_residual = record.drop(),
          .iterations = iterations};
}

}  // namespace

AdjointSolver::AdjointSolver(ImplicitIteration& iteration, const Conditions<Real>& conditions,
                             const DerivativeSettings& settings, std::function<bool()> go_on)
    : basis_(iteration, conditions, settings, std::move(go_on)) {}

void AdjointSolver::follow(std::span<const Conserved<Real>> residual_change) {
  auto& changes = residual_changes_.emplace_back();
  for (std::size_t cell = 0; cell < residual_change.size(); ++cell) {
    const auto& change = residual_change[cell];
    Real size = 0;
    for (int i = 0; i < 5; ++i) size += std::abs(change[i]);
    if (size > 0) changes.emplace_back(static_cast<Index>(cell), change);
  }
}

std::vector<Adjoint> AdjointSolver::solve(const std::vector<AdjointProblem>& problems) {
  std::vector<Adjoint> out;
  const auto solve = [&]<int N>(std::span<const AdjointProblem> group, std::integral_constant<int, N>) {
    std::array<BlockProblem, N> asked;
    for (std::size_t k = 0; k < N; ++k)
      asked[k] = {"the adjoint of " + group[k].name, basis_.settings.orders};
    AdjointOperator<N> transpose(basis_.iteration, basis_.linearisation, group, residual_changes_);
    BlockSolve<N, AdjointOperator<N>> way(transpose, basis_.iteration, basis_.linearisation.conditions(),
                                          asked, basis_.settings, basis_.go_on);
    if (!way.solve()) return false;
    for (std::size_t k = 0; k < N; ++k)
      out.push_back(adjoint_of(group[k], asked[k].orders, std::move(way.field(k)), way.record(k),
                               way.iterations(), basis_.body_size, basis_.iteration.communicator()));
    return true;
  };
  if (!in_groups(std::span(problems), solve)) return {};
  return out;
}

std::vector<Vec3> AdjointSolver::by_points(const Adjoint& adjoint, std::span<const Load> weights) {
  Field minus = adjoint.field;
  for (auto& psi : minus) psi = Real(-1) * psi;
  return shape_transpose(basis_.linearisation, basis_.iteration.flow(), minus, weights,
                         basis_.iteration.moment_center());
}

}  // namespace alphadot
