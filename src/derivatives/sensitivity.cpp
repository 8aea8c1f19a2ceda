#include "derivatives/sensitivity.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/error.hpp"
#include "derivatives/free_linearisation.hpp"
#include "derivatives/preconditioner.hpp"
#include "euler/state_change.hpp"
#include "linear/cell_scaling.hpp"
#include "linear/krylov_basis.hpp"

namespace alphadot {

namespace {

using States = std::vector<Primitive<Real>>;

/// Adds V (dU/dW) w to `image`: the change of the conserved state that goes with a change w of the primitive
/// one.
void add_mass_term(const ImplicitIteration& iteration, std::span<const Primitive<Real>> change,
                   std::span<Conserved<Real>> image) {
  const Subdomain& domain = iteration.discretization().domain();
  for (std::size_t cell = 0; cell < image.size(); ++cell)
    image[cell] += domain.volume[cell] * conserved_change(iteration.flow()[static_cast<Index>(cell)],
                                                          change[cell], iteration.discretization().gamma());
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
  bool has_stalled() const { return Preconditioner::has_stalled(norms); }
  void drop_latest() {
    loads.pop_back();
    norms.pop_back();
  }
};

/// Norms of force and moment in every component: a component that is small, or zero by symmetry, is no better
/// solved for than the others.
Load size(const Load& load) {
  const Real force = norm(load.force), moment = norm(load.moment);
  return {{force, force, force}, {moment, moment, moment}};
}

/// How far the latest loads may be from those of the solution: as many times the residual as those of any
/// earlier iteration were from the latest. The ratio differs between iterations, since residuals in some
/// cells matter more to a load than in others; the largest one counts, and twice, for it is a sample.
Load remaining_error(const Record& record, const std::vector<Load>& totals) {
  constexpr Real safety = 2, much_larger = 2;
  const Real last = record.norms.back();
  if (totals.size() == 1) return magnitude(totals.back());
  Load out;
  for (std::size_t j = 0; j + 1 < totals.size(); ++j) {
    if (record.norms[j] < much_larger * last) continue;
    const Load distance = magnitude(totals[j] - totals.back());
    const Real share = safety * last / (record.norms[j] - last);
    for (int i = 0; i < 3; ++i) {
      out.force[i] = std::max(out.force[i], share * distance.force[i]);
      out.moment[i] = std::max(out.moment[i], share * distance.moment[i]);
    }
  }
  return out;
}

/// N problems solved together: every application of the tangent serves all of them.
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
        scaling_(iteration.discretization(), iteration.flow(), linearisation.conditions()),
        preconditioner_(iteration, linearisation.conditions()),
        tangent_(linearisation, iteration.moment_center()) {
    const auto cells = static_cast<std::size_t>(iteration.discretization().domain().owned_cells);
    for (std::size_t k = 0; k < N; ++k) {
      results_[k].name = problems[k].name;
      for (States* array : {&results_[k].field, &images_[k], &corrections_[k], &defects_[k]})
        array->resize(cells);
      std::ranges::copy(problems[k].guess, results_[k].field.begin());
    }
  }

  /// Nothing when it was stopped.
  std::optional<std::array<Sensitivity, N>> solve() {
    evaluate(true);
    if (settings_.method == SensitivityMethod::march)
      march();
    else
      gmres();
    if (is_stopped_) return std::nullopt;
    for (std::size_t k = 0; k < N; ++k) finish(results_[k], problems_[k], records_[k]);
    return std::move(results_);
  }

 private:
  /// The defects D (A U + b) of all problems at their present fields; loads and norms into the records, of a
  /// further iteration or, since those of a Krylov space are carried along, in place of the latest.
  void evaluate(bool is_further) {
    typename Tangent<N>::Fields fields;
    std::array<ConditionsChange, N> changes;
    for (std::size_t k = 0; k < N; ++k) {
      fields[k] = results_[k].field;
      changes[k] = problems_[k].change;
    }
    tangent_.apply(fields, changes, spans(images_));
    for (std::size_t k = 0; k < N; ++k)
      if (!problems_[k].rate.empty()) add_mass_term(iteration_, problems_[k].rate, images_[k]);
    for (std::size_t k = 0; k < N; ++k)
      for (std::size_t cell = 0; cell < problems_[k].defect.size(); ++cell)
        images_[k][cell] += problems_[k].defect[cell];
    const auto loads = tangent_.loads();
    for (std::size_t k = 0; k < N; ++k) {
      scaling_.scale(images_[k], defects_[k]);
      if (!is_further) records_[k].drop_latest();
      records_[k].loads.push_back(numbers_of(loads[k]));
    }
    std::vector<Real> squares;
    for (const auto& defect : defects_) squares.push_back(square(defect));
    iteration_.sum(squares);
    for (std::size_t k = 0; k < N; ++k) add_norm(k, std::sqrt(squares[k]));
  }

  void add_norm(std::size_t k, Real norm) {
    records_[k].norms.push_back(norm);
    if (!std::isfinite(norm))
      throw DivergedError("the linear solve for " + problems_[k].name + " came to a norm that is no number");
  }

  static std::array<std::span<Conserved<Real>>, N> spans(std::array<States, N>& arrays) {
    std::array<std::span<Conserved<Real>>, N> out;
    for (std::size_t k = 0; k < N; ++k) out[k] = arrays[k];
    return out;
  }

  /// corrections_ = -P^-1 (A U + b), from the defects; images_ serves as a buffer.
  void precondition() {
    std::array<LinearSystem, N> systems;
    for (std::size_t k = 0; k < N; ++k) {
      scaling_.unscale(defects_[k], images_[k]);
      systems[k] = {images_[k], corrections_[k]};
    }
    preconditioner_.solve(systems);
  }

  bool all_dropped() const {
    for (std::size_t k = 0; k < N; ++k)
      if (records_[k].drop() > std::pow(10.0, -settings_.orders - problems_[k].further_orders)) return false;
    return true;
  }
  Real largest_norm() const {
    Real out = 0;
    for (const Record& record : records_) out = std::max(out, record.norms.back());
    return out;
  }

  /// U += -P^-1 (A U + b) until it is steady; from the start again with a gentler preconditioner where that
  /// grows.
  void march() {
    constexpr Real grown = 10;
    for (int count = 1; count <= settings_.max_iterations && !all_dropped(); ++count) {
      precondition();
      for (std::size_t k = 0; k < N; ++k) {
        ++results_[k].iterations;
        for (std::size_t i = 0; i < corrections_[k].size(); ++i) results_[k].field[i] += corrections_[k][i];
      }
      evaluate(true);
      if (is_stopped()) return;
      const auto growing = std::ranges::find_if(records_, [](const Record& r) { return r.drop() > grown; });
      if (growing == records_.end()) continue;
      if (!preconditioner_.can_be_damped())
        throw DivergedError("the march of the response to " +
                            problems_[static_cast<std::size_t>(growing - records_.begin())].name +
                            " grows: the steady state hides an unstable cell");
      preconditioner_.damp();
      for (std::size_t k = 0; k < N; ++k) {
        std::ranges::fill(results_[k].field, Primitive<Real>{});
        std::ranges::copy(problems_[k].guess, results_[k].field.begin());
      }
      for (auto& record : records_) record = {};
      evaluate(true);
    }
  }

  bool is_stopped() {
    is_stopped_ = is_stopped_ || (go_on_ && !go_on_());
    return is_stopped_;
  }

  /// Every iteration looks along what the preconditioner makes of the present defects, in all problems along
  /// the directions of all.
  void gmres() {
    constexpr Real single_precision = 1e-5;  // what directions kept as such can reduce a residual by
    for (int used = 0, at_level = 0; used < settings_.max_iterations && !all_dropped();) {
      if (space_.is_full()) space_.clear();
      const Real cycle_start = largest_norm();
      std::vector<KrylovBasis::System> searches;
      for (std::size_t k = 0; k < N; ++k) searches.push_back({defects_[k], records_[k].loads.back(), {}, 0});
      bool stalls = false;
      while (used < settings_.max_iterations && !space_.is_full() && !all_dropped() && !stalls &&
             largest_norm() > single_precision * cycle_start) {
        widen_space();
        space_.reduce(searches);
        for (std::size_t k = 0; k < N; ++k) {
          records_[k].loads.push_back(searches[k].functionals);
          add_norm(k, searches[k].norm);
          ++results_[k].iterations;
        }
        ++used, ++at_level;
        if (is_stopped()) return;
        stalls = at_level >= static_cast<int>(Preconditioner::stalled_iterations) &&
                 preconditioner_.can_be_damped() && std::ranges::any_of(records_, &Record::has_stalled);
      }
      for (std::size_t k = 0; k < N; ++k) space_.move(results_[k].field, searches[k].shares);
      if (stalls) {
        preconditioner_.damp();
        at_level = 0;
      }
      evaluate(false);
    }
  }

  void widen_space() {
    precondition();
    typename Tangent<N>::Fields fields;
    for (std::size_t k = 0; k < N; ++k) fields[k] = corrections_[k];
    tangent_.apply(fields, {}, spans(images_));
    const auto loads = tangent_.loads();
    std::vector<KrylovBasis::Candidate> candidates;
    for (std::size_t k = 0; k < N; ++k) {
      scaling_.scale(images_[k], images_[k]);
      candidates.push_back({corrections_[k], images_[k], numbers_of(loads[k])});
    }
    space_.add(candidates);
  }

  void finish(Sensitivity& result, const SensitivityProblem& problem, Record& record) const {
    std::vector<Load> totals;
    for (auto& loads : record.loads) {
      comm_.sum(loads);
      result.loads = loads_of(loads);
      totals.push_back(total_of(result.loads));
    }
    result.total = totals.back();
    result.relative_residual = record.drop();
    constexpr Real of_other_components = 0.05;
    const Real share = of_other_components * result.relative_residual + problem.rate_residual;
    result.total_error = remaining_error(record, totals) + share * size(result.total);
  }

  ImplicitIteration& iteration_;
  const Communicator& comm_;
  std::span<const SensitivityProblem> problems_;
  DerivativeSettings settings_;
  KrylovBasis space_;
  const std::function<bool()>& go_on_;
  bool is_stopped_ = false;
  CellScaling scaling_;
  Preconditioner preconditioner_;
  Tangent<N> tangent_;
  std::array<Sensitivity, N> results_;
  std::array<Record, N> records_;
  std::array<States, N> images_, corrections_, defects_;
};

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
      linearisation_(linearise_with_free_limiter(iteration, conditions)),
      settings_(settings),
      go_on_(std::move(go_on)) {}

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
