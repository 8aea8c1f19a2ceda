#include "derivatives/sensitivity.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/dual.hpp"
#include "core/error.hpp"
#include "linear/krylov_basis.hpp"

namespace alphadot {

namespace {

using States = std::vector<Primitive<Real>>;

constexpr Real linear_cfl = 1e8;  // no time term: the preconditioner is the plain Jacobian

/// Adds V (dU/dW) w to `image`: the change of the conserved state that goes with a change w of the primitive
/// one.
void add_mass_term(const ImplicitIteration& iteration, std::span<const Primitive<Real>> change,
                   std::span<Conserved<Real>> image) {
  const Subdomain& domain = iteration.discretization().domain();
  for (Index cell = 0; cell < domain.owned_cells; ++cell) {
    Primitive<Dual<1>> w;
    for (int i = 0; i < 5; ++i) {
      w[i] = iteration.flow()[cell][i];
      w[i].d[0] = change[static_cast<std::size_t>(cell)][i];
    }
    const auto u = conserved(w, iteration.discretization().gamma());
    for (int i = 0; i < 5; ++i) image[static_cast<std::size_t>(cell)][i] += domain.volume[cell] * u[i].d[0];
  }
}

Load magnitude(const Load& load) {
  Load out;
  for (int i = 0; i < 3; ++i) {
    out.force[i] = std::abs(load.force[i]);
    out.moment[i] = std::abs(load.moment[i]);
  }
  return out;
}

/// The way of one problem to its solution: loads (of this rank only) and norm after every iteration.
struct Record {
  std::vector<std::vector<Real>> loads;
  std::vector<Real> norms;
  Real drop() const { return norms.back() / std::max(norms.front(), Real{1e-300}); }
};

/// Error that the latest changes leave when they go on to shrink as the residual did over the last
/// iterations.
Load remaining_error(const Record& record, const std::vector<Load>& totals) {
  constexpr std::size_t span = 4;
  const std::size_t last = totals.size() - 1, before = last - std::min(last, span);
  if (last == 0) return magnitude(totals.back());
  const Real drop = record.norms[last] / std::max(record.norms[before], Real{1e-300});
  const Real rate = std::clamp(std::pow(drop, 1.0 / static_cast<Real>(last - before)), 0.3, 0.95);
  Load change = magnitude(totals[last] - totals[last - 1]);
  if (last > 1) {
    const Load earlier = magnitude(totals[last - 1] - totals[last - 2]);
    for (int i = 0; i < 3; ++i) {
      change.force[i] = std::max(change.force[i], earlier.force[i]);
      change.moment[i] = std::max(change.moment[i], earlier.moment[i]);
    }
  }
  return rate / (1 - rate) * change;
}

/// N problems solved in lockstep: every application of the tangent serves all of them.
template <int N>
class BlockGmres {
 public:
  BlockGmres(ImplicitIteration& iteration, const Linearisation& linearisation,
             std::span<const SensitivityProblem> problems, const DerivativeSettings& settings,
             const std::function<bool()>& go_on)
      : iteration_(iteration),
        comm_(iteration.communicator()),
        problems_(problems),
        settings_(settings),
        space_(static_cast<std::size_t>(iteration.discretization().domain().owned_cells), settings.directions,
               [this](std::vector<Real>& numbers) { iteration_.sum(numbers); }),
        go_on_(go_on),
        tangent_(linearisation, iteration.moment_center()) {
    const auto cells = static_cast<std::size_t>(iteration.discretization().domain().owned_cells);
    for (std::size_t k = 0; k < N; ++k) {
      results_[k].name = problems[k].name;
      results_[k].field.resize(cells);
      images_[k].resize(cells);
      corrections_[k].resize(cells);
      products_[k].resize(cells);
    }
  }

  /// Nothing when it was stopped.
  std::optional<std::array<Sensitivity, N>> solve() {
    evaluate();
    if (settings_.method == SensitivityMethod::march)
      march();
    else
      gmres();
    if (is_stopped_) return std::nullopt;
    for (std::size_t k = 0; k < N; ++k) finish(results_[k], records_[k]);
    return std::move(results_);
  }

 private:
  /// corrections_ = -P^-1 (A U + b) of all problems at their present fields; loads and norms into the
  /// records.
  void evaluate() {
    typename Tangent<N>::Fields fields;
    std::array<ConditionsChange, N> changes;
    for (std::size_t k = 0; k < N; ++k) {
      fields[k] = results_[k].field;
      changes[k] = problems_[k].change;
    }
    tangent_.apply(fields, changes, spans());
    for (std::size_t k = 0; k < N; ++k)
      if (!problems_[k].rate.empty()) add_mass_term(iteration_, problems_[k].rate, images_[k]);
    precondition(corrections_);
    const auto loads = tangent_.loads();
    for (std::size_t k = 0; k < N; ++k) records_[k].loads.push_back(numbers_of(loads[k]));
    record_norms();
  }

  void record_norms() {
    std::vector<Real> squares;
    for (const auto& correction : corrections_) squares.push_back(square(correction));
    iteration_.sum(squares);
    for (std::size_t k = 0; k < N; ++k) records_[k].norms.push_back(std::sqrt(squares[k]));
  }

  typename Tangent<N>::Images spans() {
    typename Tangent<N>::Images out;
    for (std::size_t k = 0; k < N; ++k) out[k] = images_[k];
    return out;
  }

  /// out = -P^-1 images_.
  void precondition(std::array<States, N>& out) {
    std::array<LinearSystem, N> systems;
    for (std::size_t k = 0; k < N; ++k) systems[k] = {images_[k], out[k]};
    iteration_.linear_solver().preconditioner().solve(systems);
  }

  bool all_dropped(Real share) const {
    return std::ranges::all_of(records_, [&](const Record& record) { return record.drop() <= share; });
  }
  Real largest_norm() const {
    Real out = 0;
    for (const Record& record : records_) out = std::max(out, record.norms.back());
    return out;
  }

  /// U += -P^-1 (A U + b) until it is steady.
  void march() {
    for (int count = 1; count <= settings_.max_iterations && !all_dropped(target_); ++count) {
      for (std::size_t k = 0; k < N; ++k) {
        ++results_[k].iterations;
        for (std::size_t i = 0; i < corrections_[k].size(); ++i) results_[k].field[i] += corrections_[k][i];
      }
      evaluate();
      for (std::size_t k = 0; k < N; ++k)
        if (!(records_[k].drop() < 1e6))
          throw DivergedError("the march of the response to " + problems_[k].name +
                              " grows: the steady state hides an unstable cell");
      if (is_stopped()) return;
    }
  }

  bool is_stopped() {
    is_stopped_ = is_stopped_ || (go_on_ && !go_on_());
    return is_stopped_;
  }

  /// Every iteration looks along the present corrections, in all problems along those of all.
  void gmres() {
    constexpr Real single_precision = 1e-5;  // what directions kept as such can reduce a residual by
    for (int used = 0; used < settings_.max_iterations && !all_dropped(target_);) {
      if (used > 0) evaluate();
      if (space_.is_full()) space_.clear();
      const Real cycle_start = largest_norm();
      std::vector<KrylovBasis::System> searches;
      for (std::size_t k = 0; k < N; ++k)
        searches.push_back({corrections_[k], records_[k].loads.back(), {}, 0});
      while (used < settings_.max_iterations && !space_.is_full() && !all_dropped(target_) &&
             largest_norm() > single_precision * cycle_start) {
        widen_space();
        space_.reduce(searches);
        for (std::size_t k = 0; k < N; ++k) {
          records_[k].loads.push_back(searches[k].functionals);
          records_[k].norms.push_back(searches[k].norm);
          ++results_[k].iterations;
        }
        ++used;
        if (is_stopped()) return;
      }
      for (std::size_t k = 0; k < N; ++k) space_.move(results_[k].field, searches[k].shares);
    }
  }

  void widen_space() {
    typename Tangent<N>::Fields fields;
    for (std::size_t k = 0; k < N; ++k) fields[k] = corrections_[k];
    tangent_.apply(fields, {}, spans());
    const auto loads = tangent_.loads();
    precondition(products_);
    std::vector<KrylovBasis::Candidate> candidates;
    for (std::size_t k = 0; k < N; ++k)
      candidates.push_back({corrections_[k], products_[k], numbers_of(loads[k])});
    space_.add(candidates);
  }

  void finish(Sensitivity& result, Record& record) const {
    std::vector<Load> totals;
    for (auto& loads : record.loads) {
      comm_.sum(loads);
      result.loads = loads_of(loads);
      totals.push_back(total_of(result.loads));
    }
    result.total = totals.back();
    result.total_error = remaining_error(record, totals);
    result.relative_residual = record.drop();
  }

  ImplicitIteration& iteration_;
  const Communicator& comm_;
  std::span<const SensitivityProblem> problems_;
  DerivativeSettings settings_;
  KrylovBasis space_;
  const std::function<bool()>& go_on_;
  bool is_stopped_ = false;
  Real target_ = std::pow(10.0, -settings_.orders);
  Tangent<N> tangent_;
  std::array<Sensitivity, N> results_;
  std::array<Record, N> records_;
  std::array<std::vector<Conserved<Real>>, N> images_;
  std::array<States, N> corrections_, products_;
};

/// About the flow with its limiter free, as it is in a motion.
Linearisation linearisation_of(ImplicitIteration& iteration, const Conditions<Real>& conditions) {
  const Discretization& discretization = iteration.discretization();
  Reconstruction<Real> reconstruction(discretization, iteration.communicator());
  if (discretization.space().order > 1) {
    iteration.flow().start_exchange();
    reconstruction.update(iteration.flow());
    reconstruction.start_exchange();
    reconstruction.finish_exchange();
  }
  return {discretization, iteration.communicator(), iteration.flow(), reconstruction, conditions};
}

/// False when it was stopped.
template <int N>
bool solve_group(ImplicitIteration& iteration, const Linearisation& linearisation,
                 std::span<const SensitivityProblem> problems, const DerivativeSettings& settings,
                 const std::function<bool()>& go_on, std::vector<Sensitivity>& out) {
  auto results = BlockGmres<N>(iteration, linearisation, problems, settings, go_on).solve();
  if (!results) return false;
  for (auto& result : *results) out.push_back(std::move(result));
  return true;
}

}  // namespace

SensitivitySolver::SensitivitySolver(ImplicitIteration& iteration, const Conditions<Real>& conditions,
                                     const DerivativeSettings& settings, std::function<bool()> go_on)
    : iteration_(iteration),
      linearisation_(linearisation_of(iteration, conditions)),
      settings_(settings),
      go_on_(std::move(go_on)) {
  iteration.linear_solver().preconditioner().linearise(iteration.flow(), conditions, {.cfl = linear_cfl});
}

std::vector<Sensitivity> SensitivitySolver::solve(const std::vector<SensitivityProblem>& problems) {
  std::vector<Sensitivity> out;
  for (std::size_t begin = 0; begin < problems.size();) {
    const auto group =
        std::span(problems).subspan(begin, std::min<std::size_t>(at_a_time, problems.size() - begin));
    const auto solve = group.size() == 3   ? solve_group<3>
                       : group.size() == 2 ? solve_group<2>
                                           : solve_group<1>;
    if (!solve(iteration_, linearisation_, group, settings_, go_on_, out)) return {};
    begin += group.size();
  }
  return out;
}

}  // namespace alphadot
