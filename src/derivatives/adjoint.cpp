#include "derivatives/adjoint.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "core/error.hpp"
#include "derivatives/free_linearisation.hpp"
#include "derivatives/preconditioner.hpp"
#include "euler/state_change.hpp"
#include "linear/krylov_basis.hpp"
#include "linear/shape_transpose.hpp"
#include "space/wave_speed.hpp"

namespace alphadot {

namespace {

using Field = std::vector<Five<Real>>;

/// Adds V (dU/dW)^T y to `image`.
void add_transposed_mass_term(const ImplicitIteration& iteration, std::span<const Conserved<Real>> y,
                              std::span<Primitive<Real>> image) {
  const Subdomain& domain = iteration.discretization().domain();
  for (std::size_t cell = 0; cell < image.size(); ++cell)
    image[cell] +=
        domain.volume[cell] * conserved_change_transposed(iteration.flow()[static_cast<Index>(cell)], y[cell],
                                                          iteration.discretization().gamma());
}

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

Real dot_product(std::span<const Five<Real>> a, std::span<const Five<Real>> b) {
  Five<Real> sum;
  for (std::size_t cell = 0; cell < a.size(); ++cell)
    for (int i = 0; i < 5; ++i) sum[i] += a[cell][i] * b[cell][i];
  return sum[0] + sum[1] + sum[2] + sum[3] + sum[4];
}

/// The way of one problem to its solution, after every iteration: psi . R_c less the load's own part, of this
/// rank only, and the norm.
struct Record {
  std::vector<std::vector<Real>> products;
  std::vector<Real> norms;
  Real drop() const { return norms.back() / std::max(norms.front(), Real{1e-300}); }
};

/// As many times the residual as the products of any earlier iteration were from the latest, twice, and a
/// share of the largest product, as in the forward solves.
std::vector<Real> remaining_error(const Record& record) {
  constexpr Real safety = 2, much_larger = 2, of_other_components = 0.05;
  const auto& latest = record.products.back();
  const Real last = record.norms.back();
  Real largest = 0;
  for (const Real product : latest) largest = std::max(largest, std::abs(product));
  std::vector<Real> out(latest.size(), of_other_components * record.drop() * largest);
  if (record.norms.size() == 1)
    for (std::size_t i = 0; i < out.size(); ++i) out[i] += std::abs(latest[i]);
  for (std::size_t i = 0; i < out.size(); ++i) {
    Real distance = 0;
    for (std::size_t j = 0; j + 1 < record.norms.size(); ++j)
      if (record.norms[j] >= much_larger * last)
        distance = std::max(
            distance, safety * last / (record.norms[j] - last) * std::abs(record.products[j][i] - latest[i]));
    out[i] += distance;
  }
  return out;
}

/// N adjoint problems, whose solutions look along the directions of all: GMRES with the transposed scheme on
/// the right, so that what it makes small is the true residual.
template <int N>
class BlockGmres {
 public:
  BlockGmres(ImplicitIteration& iteration, const Linearisation& linearisation,
             std::span<const AdjointProblem> problems,
             std::span<const std::span<const Conserved<Real>>> residual_changes,
             const DerivativeSettings& settings, const std::function<bool()>& go_on)
      : iteration_(iteration),
        problems_(problems),
        residual_changes_(residual_changes),
        settings_(settings),
        space_(static_cast<std::size_t>(iteration.discretization().domain().owned_cells), settings.directions,
               [this](std::vector<Real>& numbers) { iteration_.sum(numbers); }),
        go_on_(go_on),
        preconditioner_(iteration, linearisation.conditions(), Transposed::yes),
        waves_(wave_speeds(iteration.discretization(), iteration.flow(), linearisation.conditions())),
        transpose_(linearisation, iteration.moment_center()) {
    for (std::size_t k = 0; k < N; ++k) {
      results_[k].name = problems[k].name;
      for (Field* field : {&results_[k].field, &images_[k], &corrections_[k], &defects_[k]})
        field->resize(waves_.size());
    }
  }

  /// Nothing when it was stopped.
  std::optional<std::array<Adjoint, N>> solve() {
    constexpr Real single_precision = 1e-5;  // what directions kept as such can reduce a residual by
    evaluate();
    for (int used = 0, at_level = 0; used < settings_.max_iterations && !all_dropped();) {
      if (used > 0) evaluate();
      if (space_.is_full()) space_.clear();
      const Real cycle_start = largest_norm();
      std::vector<KrylovBasis::System> searches;
      for (std::size_t k = 0; k < N; ++k)
        searches.push_back({defects_[k], records_[k].products.back(), {}, 0});
      bool stalls = false;
      while (used < settings_.max_iterations && !space_.is_full() && !all_dropped() && !stalls &&
             largest_norm() > single_precision * cycle_start) {
        widen_space();
        space_.reduce(searches);
        for (std::size_t k = 0; k < N; ++k) {
          records_[k].products.push_back(searches[k].functionals);
          add_norm(k, searches[k].norm);
          ++results_[k].iterations;
        }
        ++used, ++at_level;
        if (go_on_ && !go_on_()) return std::nullopt;
        stalls = at_level >= static_cast<int>(Preconditioner::stalled_iterations) &&
                 preconditioner_.can_be_damped() && std::ranges::any_of(records_, [](const Record& record) {
                   return Preconditioner::has_stalled(record.norms);
                 });
      }
      for (std::size_t k = 0; k < N; ++k) space_.move(results_[k].field, searches[k].shares);
      if (stalls) {
        preconditioner_.damp();
        at_level = 0;
      }
    }
    for (std::size_t k = 0; k < N; ++k) finish(results_[k], records_[k]);
    return std::move(results_);
  }

 private:
  /// The defects D (A^T psi - b) of all problems at their present fields; products and norms into the
  /// records.
  void evaluate() {
    std::array<std::vector<Load>, N> minus;
    typename TangentTranspose<N>::Weights weights;
    typename TangentTranspose<N>::Adjoints fields;
    for (std::size_t k = 0; k < N; ++k) {
      for (const Load& weight : problems_[k].weights) minus[k].push_back(-1 * weight);
      weights[k] = minus[k];
      fields[k] = results_[k].field;
    }
    transpose_.apply(fields, weights, images());
    const auto products = transpose_.conditions(weights);
    std::vector<Real> squares;
    for (std::size_t k = 0; k < N; ++k) {
      if (!problems_[k].rate.empty()) add_transposed_mass_term(iteration_, problems_[k].rate, images_[k]);
      scale(images_[k], defects_[k]);
      records_[k].products.push_back(products_of(products[k], results_[k].field));
      squares.push_back(square(defects_[k]));
    }
    iteration_.sum(squares);
    for (std::size_t k = 0; k < N; ++k) add_norm(k, std::sqrt(squares[k]));
  }

  void widen_space() {
    std::array<LinearSystem, N> systems;
    typename TangentTranspose<N>::Adjoints fields;
    for (std::size_t k = 0; k < N; ++k) {
      for (std::size_t cell = 0; cell < waves_.size(); ++cell)
        images_[k][cell] = waves_[cell] * defects_[k][cell];
      systems[k] = {images_[k], corrections_[k]};
      fields[k] = corrections_[k];
    }
    preconditioner_.solve(systems);
    transpose_.apply(fields, {}, images());
    const auto products = transpose_.conditions({});
    std::vector<KrylovBasis::Candidate> candidates;
    for (std::size_t k = 0; k < N; ++k) {
      scale(images_[k], images_[k]);
      candidates.push_back({corrections_[k], images_[k], products_of(products[k], corrections_[k])});
    }
    space_.add(candidates);
  }

  /// Of an adjoint with the changes of the residual by conditions, which come as one change, and by whatever
  /// else is followed.
  std::vector<Real> products_of(const ConditionsChange& by_conditions,
                                std::span<const Conserved<Real>> adjoint) const {
    auto out = numbers_of(by_conditions);
    for (const auto& change : residual_changes_) out.push_back(dot_product(adjoint, change));
    return out;
  }

  typename TangentTranspose<N>::Images images() {
    typename TangentTranspose<N>::Images out;
    for (std::size_t k = 0; k < N; ++k) out[k] = images_[k];
    return out;
  }
  /// D: what a defect changes an adjoint by while a wave crosses the cell.
  void scale(std::span<const Five<Real>> image, std::span<Five<Real>> out) const {
    for (std::size_t cell = 0; cell < waves_.size(); ++cell) out[cell] = (1 / waves_[cell]) * image[cell];
  }

  void add_norm(std::size_t k, Real norm) {
    records_[k].norms.push_back(norm);
    if (!std::isfinite(norm))
      throw DivergedError("the linear solve for the adjoint of " + problems_[k].name + " left the numbers");
  }
  bool all_dropped() const {
    return std::ranges::all_of(records_, [&](const Record& record) { return record.drop() <= target_; });
  }
  Real largest_norm() const {
    Real out = 0;
    for (const Record& record : records_) out = std::max(out, record.norms.back());
    return out;
  }

  void finish(Adjoint& result, Record& record) const {
    std::vector<Real> all;
    for (const auto& products : record.products) all.insert(all.end(), products.begin(), products.end());
    iteration_.communicator().sum(all);
    auto next = all.begin();
    for (auto& products : record.products)
      for (Real& product : products) product = *next++;
    const auto error = remaining_error(record);
    std::vector<Real> sensitivity;  // dJ/dc = J_c - psi . R_c
    for (const Real product : record.products.back()) sensitivity.push_back(-product);
    result.sensitivity = change_of(sensitivity);
    result.sensitivity_error = change_of(error);
    result.products.assign(sensitivity.begin() + numbers_of_change, sensitivity.end());
    result.products_error.assign(error.begin() + numbers_of_change, error.end());
    result.relative_residual = record.drop();
  }

  ImplicitIteration& iteration_;
  std::span<const AdjointProblem> problems_;
  std::span<const std::span<const Conserved<Real>>> residual_changes_;
  DerivativeSettings settings_;
  KrylovBasis space_;
  const std::function<bool()>& go_on_;
  Real target_ = std::pow(10.0, -settings_.orders);
  Preconditioner preconditioner_;
  std::vector<Real> waves_;  // [owned_cells] sum over the faces of area times wave speed
  TangentTranspose<N> transpose_;
  std::array<Adjoint, N> results_;
  std::array<Record, N> records_;
  std::array<Field, N> images_, corrections_, defects_;
};

/// False when it was stopped.
template <int N>
bool solve_group(ImplicitIteration& iteration, const Linearisation& linearisation,
                 std::span<const AdjointProblem> problems,
                 std::span<const std::span<const Conserved<Real>>> residual_changes,
                 const DerivativeSettings& settings, const std::function<bool()>& go_on,
                 std::vector<Adjoint>& out) {
  auto results = BlockGmres<N>(iteration, linearisation, problems, residual_changes, settings, go_on).solve();
  if (!results) return false;
  for (auto& result : *results) out.push_back(std::move(result));
  return true;
}

}  // namespace

AdjointSolver::AdjointSolver(ImplicitIteration& iteration, const Conditions<Real>& conditions,
                             const DerivativeSettings& settings, std::function<bool()> go_on)
    : iteration_(iteration),
      linearisation_(linearise_with_free_limiter(iteration, conditions)),
      settings_(settings),
      go_on_(std::move(go_on)) {}

std::vector<Adjoint> AdjointSolver::solve(const std::vector<AdjointProblem>& problems) {
  std::vector<Adjoint> out;
  for (std::size_t begin = 0; begin < problems.size();) {
    const auto group =
        std::span(problems).subspan(begin, std::min<std::size_t>(at_a_time, problems.size() - begin));
    const auto solve = group.size() == 3   ? solve_group<3>
                       : group.size() == 2 ? solve_group<2>
                                           : solve_group<1>;
    if (!solve(iteration_, linearisation_, group, residual_changes_, settings_, go_on_, out)) return {};
    begin += group.size();
  }
  return out;
}

std::vector<Vec3> AdjointSolver::by_points(const Adjoint& adjoint, std::span<const Load> weights) {
  Field minus = adjoint.field;
  for (auto& psi : minus) psi = Real(-1) * psi;
  return shape_transpose(linearisation_, iteration_.flow(), minus, weights, iteration_.moment_center());
}

}  // namespace alphadot
