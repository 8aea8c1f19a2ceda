#include "derivatives/sensitivity.hpp"

#include <array>
#include <utility>

#include "derivatives/block_solve.hpp"
#include "derivatives/loads.hpp"
#include "derivatives/mass_term.hpp"
#include "derivatives/remaining_error.hpp"
#include "linear/cell_scaling.hpp"

namespace alphadot {

namespace {

/// The tangent of the residual with the problems' sources, as a block solve wants it.
template <int N>
class ForwardOperator {
 public:
  static constexpr std::size_t parts = 1;
  static constexpr auto transposed = Transposed::no;

  ForwardOperator(ImplicitIteration& iteration, const Linearisation& linearisation,
                  std::span<const SensitivityProblem> problems)
      : iteration_(iteration),
        problems_(problems),
        scaling_(iteration.discretization(), iteration.flow(), linearisation.conditions()),
        tangent_(linearisation, iteration.moment_center()) {}

  void apply(const typename Tangent<N>::Fields& fields, const typename Tangent<N>::Images& images,
             bool with_source) {
    std::array<ConditionsChange, N> changes;
    for (std::size_t k = 0; with_source && k < N; ++k) changes[k] = problems_[k].change;
    tangent_.apply(fields, changes, images);
    loads_ = tangent_.loads();
    for (std::size_t k = 0; with_source && k < N; ++k) {
      if (!problems_[k].rate.empty()) add_mass_term(iteration_, 1, problems_[k].rate, images[k]);
      for (std::size_t cell = 0; cell < problems_[k].defect.size(); ++cell)
        images[k][cell] += problems_[k].defect[cell];
      for (std::size_t patch = 0; patch < problems_[k].own_loads.size(); ++patch)
        loads_[k][patch] += problems_[k].own_loads[patch];
    }
  }
  std::vector<Real> functionals(std::size_t k) const { return numbers_of(loads_[k]); }
  void scale(std::span<const Conserved<Real>> image, std::span<Primitive<Real>> out) const {
    scaling_.scale(image, out);
  }
  void unscale(std::span<const Primitive<Real>> scaled, std::span<Conserved<Real>> out) const {
    scaling_.unscale(scaled, out);
  }

 private:
  ImplicitIteration& iteration_;
  std::span<const SensitivityProblem> problems_;
  CellScaling scaling_;
  Tangent<N> tangent_;
  std::array<std::vector<Load>, N> loads_;
};

Sensitivity sensitivity_of(const SensitivityProblem& problem, Real orders, std::vector<Primitive<Real>> field,
                           BlockRecord record, int iterations, Real body_size, const Communicator& comm) {
  Sensitivity out;
  out.name = problem.name;
  out.field = std::move(field);
  std::vector<std::vector<Real>> totals;
  for (auto& functionals : record.functionals) {
    comm.sum(functionals);
    out.loads = loads_of(functionals);
    out.total = total_of(out.loads);
    totals.push_back(numbers_of(std::span(&out.total, 1)));
  }
  out.relative_residual = record.drop();
  out.iterations = iterations;
  const auto left = [&](std::span<const std::vector<Real>> functionals, std::span<const Real> scales) {
    return remaining_error(record.norms, functionals, scales, out.relative_residual, orders,
                           bends + problem.rate_error);
  };
  const auto scales = scales_of(out.total, body_size, 1);
  const auto error = left(totals, scales);
  out.relative_error = relative_error(error, scales);
  out.total_error = loads_of(error).front();
  out.loads_error = loads_of(left(record.functionals, scales_of(out.total, body_size, out.loads.size())));
  return out;
}

}  // namespace

SensitivitySolver::SensitivitySolver(ImplicitIteration& iteration, const Conditions<Real>& conditions,
                                     const DerivativeSettings& settings, std::function<bool()> go_on)
    : basis_(iteration, conditions, settings, std::move(go_on)) {}

std::vector<std::vector<Load>> SensitivitySolver::face_loads(
    const std::vector<SensitivityProblem>& problems,
    const std::vector<std::span<const Primitive<Real>>>& solutions) {
  const ImplicitIteration& iteration = basis_.iteration;
  std::vector<std::vector<Load>> out;
  const auto apply = [&]<int N>(std::span<const SensitivityProblem> group, std::integral_constant<int, N>) {
    std::array<ConditionsChange, N> changes;
    std::array<std::vector<Conserved<Real>>, N> values;
    typename Tangent<N>::Fields fields;
    typename Tangent<N>::Images images;
    for (std::size_t k = 0; k < N; ++k) {
      changes[k] = group[k].change;
      fields[k] = solutions[out.size() + k];
      values[k].resize(fields[k].size());
      images[k] = values[k];
    }
    Tangent<N> tangent(basis_.linearisation, iteration.moment_center());
    tangent.apply(fields, changes, images);
    for (const auto& pressures : tangent.pressures())
      out.push_back(alphadot::face_loads(iteration.discretization(), pressures, iteration.moment_center()));
    return true;
  };
  in_groups(std::span(problems), apply);
  return out;
}

std::vector<Sensitivity> SensitivitySolver::solve(const std::vector<SensitivityProblem>& problems) {
  std::vector<Sensitivity> out;
  const auto solve = [&]<int N>(std::span<const SensitivityProblem> group, std::integral_constant<int, N>) {
    std::array<BlockProblem, N> asked;
    for (std::size_t k = 0; k < N; ++k)
      asked[k] = {group[k].name, basis_.settings.orders + group[k].further_orders, group[k].guess};
    ForwardOperator<N> tangent(basis_.iteration, basis_.linearisation, group);
    BlockSolve<N, ForwardOperator<N>> way(tangent, basis_.iteration, basis_.linearisation.conditions(), asked,
                                          basis_.settings, basis_.go_on);
    if (!way.solve()) return false;
    for (std::size_t k = 0; k < N; ++k)
      out.push_back(sensitivity_of(group[k], asked[k].orders, std::move(way.field(k)), way.record(k),
                                   way.iterations(), basis_.body_size, basis_.iteration.communicator()));
    return true;
  };
  if (!in_groups(std::span(problems), solve)) return {};
  return out;
}

}  // namespace alphadot
