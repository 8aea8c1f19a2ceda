#include "solver/sensitivity.hpp"

#include <algorithm>
#include <cmath>

#include "core/error.hpp"
#include "solver/krylov_space.hpp"

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

/// N problems solved in lockstep: every application of the tangent serves all of them.
template <int N>
class Lockstep {
 public:
  Lockstep(ImplicitIteration& iteration, const Conditions<Real>& conditions,
           std::span<const SensitivityProblem> problems, const DerivativeSettings& settings,
           const Vec3& center)
      : iteration_(iteration),
        comm_(iteration.communicator()),
        problems_(problems),
        settings_(settings),
        cells_(static_cast<std::size_t>(iteration.discretization().domain().owned_cells)),
        tangent_(iteration.discretization(), comm_, iteration.flow(), conditions, center) {
    for (std::size_t k = 0; k < N; ++k) {
      results_[k].name = problems[k].name;
      results_[k].field.resize(cells_);
      images_[k].resize(cells_);
      work_[k].resize(cells_);
    }
  }

  std::array<Sensitivity, N> solve() {
    first_ = norms(residual());
    if (settings_.method == SensitivityMethod::march)
      march();
    else
      gmres();
    const auto last = norms(residual());
    for (std::size_t k = 0; k < N; ++k)
      results_[k].relative_residual = last[k] / std::max(first_[k], Real{1e-300});
    estimate_errors();
    return std::move(results_);
  }

 private:
  /// images_ = A U + b of all problems at their present fields, and the loads.
  std::array<std::vector<Conserved<Real>>, N>& residual() {
    typename Tangent<N>::Fields fields;
    std::array<ConditionsChange, N> changes;
    for (std::size_t k = 0; k < N; ++k) {
      fields[k] = results_[k].field;
      changes[k] = problems_[k].change;
    }
    tangent_.apply(fields, changes, spans());
    for (std::size_t k = 0; k < N; ++k)
      if (!problems_[k].rate.empty()) add_mass_term(iteration_, problems_[k].rate, images_[k]);
    take_loads();
    return images_;
  }

  typename Tangent<N>::Images spans() {
    typename Tangent<N>::Images out;
    for (std::size_t k = 0; k < N; ++k) out[k] = images_[k];
    return out;
  }

  /// One more correction -P^-1 (A U + b), not added to the fields, shows how far the loads may still go.
  /// Corrections of a march shrink by a rate of 0.9 at worst where it converges at all, so that all that
  /// follow make ten of the first.
  void estimate_errors() {
    constexpr Real corrections_to_come = 10;
    precondition();
    std::array<Load, N> totals;
    for (std::size_t k = 0; k < N; ++k) {
      totals[k] = results_[k].total;
      for (std::size_t i = 0; i < cells_; ++i) results_[k].field[i] += work_[k][i];
    }
    residual();
    for (std::size_t k = 0; k < N; ++k) {
      results_[k].total_error = corrections_to_come * (results_[k].total - totals[k]);
      for (std::size_t i = 0; i < cells_; ++i) results_[k].field[i] -= work_[k][i];
    }
  }

  void take_loads() {
    auto loads = tangent_.loads();
    std::vector<Real> buffer;
    for (const auto& patches : loads)
      for (const auto& load : patches)
        for (int i = 0; i < 3; ++i) {
          buffer.push_back(load.force[i]);
          buffer.push_back(load.moment[i]);
        }
    comm_.sum(buffer);
    auto next = buffer.begin();
    for (std::size_t k = 0; k < N; ++k) {
      Load total;
      for (auto& load : loads[k]) {
        for (int i = 0; i < 3; ++i) {
          load.force[i] = *next++;
          load.moment[i] = *next++;
        }
        total += load;
      }
      results_[k].loads = loads[k];
      results_[k].total = total;
    }
  }

  std::array<Real, N> norms(const std::array<std::vector<Conserved<Real>>, N>& vectors) const {
    std::array<Real, N> sums{};
    for (std::size_t k = 0; k < N; ++k)
      for (const auto& value : vectors[k])
        for (int i = 0; i < 5; ++i) sums[k] += value[i] * value[i];
    comm_.sum(std::span<Real>(sums));
    for (Real& sum : sums) sum = std::sqrt(sum);
    return sums;
  }

  /// work_ = -P^-1 images_.
  void precondition() {
    std::array<LinearSystem, N> systems;
    for (std::size_t k = 0; k < N; ++k) systems[k] = {images_[k], work_[k]};
    iteration_.linear_solver().solve(systems);
  }

  bool all_below(const std::array<Real, N>& values, const std::array<Real, N>& first) const {
    for (std::size_t k = 0; k < N; ++k)
      if (values[k] > std::pow(10.0, -settings_.orders) * first[k]) return false;
    return true;
  }

  /// U += -P^-1 (A U + b) until it is steady.
  void march() {
    for (int count = 1; count <= settings_.max_iterations; ++count) {
      precondition();
      for (std::size_t k = 0; k < N; ++k) {
        ++results_[k].iterations;
        for (std::size_t i = 0; i < cells_; ++i) results_[k].field[i] += work_[k][i];
      }
      const auto left = norms(residual());
      for (std::size_t k = 0; k < N; ++k)
        if (!(left[k] < 1e6 * first_[k]))
          throw DivergedError("the march of the response to " + problems_[k].name +
                              " grows: the steady state hides an unstable cell");
      if (all_below(left, first_)) return;
    }
  }

  void gmres() {
    std::vector<KrylovSpace> spaces(N, KrylovSpace(cells_, settings_.restart, comm_));
    std::array<Real, N> left{}, start{};
    for (int used = 0; used < settings_.max_iterations;) {
      if (used > 0) residual();
      precondition();
      for (std::size_t k = 0; k < N; ++k) left[k] = spaces[k].start(work_[k]);
      if (used == 0) start = left;
      if (all_below(left, start)) return;
      while (!spaces[0].is_full() && used < settings_.max_iterations && !all_below(left, start)) {
        typename Tangent<N>::Fields fields;
        for (std::size_t k = 0; k < N; ++k) fields[k] = spaces[k].direction();
        tangent_.apply(fields, {}, spans());
        precondition();
        for (std::size_t k = 0; k < N; ++k) {
          for (auto& value : work_[k]) value = Real{-1} * value;
          left[k] = spaces[k].extend(work_[k]);
          ++results_[k].iterations;
        }
        ++used;
      }
      for (std::size_t k = 0; k < N; ++k) {
        const auto weights = spaces[k].weights();
        for (int j = 0; j < spaces[k].size(); ++j)
          for (std::size_t i = 0; i < cells_; ++i) results_[k].field[i] += weights(j) * spaces[k].basis(j)[i];
      }
    }
  }

  ImplicitIteration& iteration_;
  const Communicator& comm_;
  std::span<const SensitivityProblem> problems_;
  DerivativeSettings settings_;
  std::size_t cells_;
  Tangent<N> tangent_;
  std::array<Sensitivity, N> results_;
  std::array<std::vector<Conserved<Real>>, N> images_;
  std::array<States, N> work_;
  std::array<Real, N> first_{};
};

template <int N>
void solve_group(ImplicitIteration& iteration, const Conditions<Real>& conditions,
                 std::span<const SensitivityProblem> problems, const DerivativeSettings& settings,
                 std::vector<Sensitivity>& out) {
  for (auto& result :
       Lockstep<N>(iteration, conditions, problems, settings, iteration.moment_center()).solve())
    out.push_back(std::move(result));
}

}  // namespace

std::vector<Sensitivity> solve_sensitivities(ImplicitIteration& iteration, const Conditions<Real>& conditions,
                                             const std::vector<SensitivityProblem>& problems,
                                             const DerivativeSettings& settings) {
  iteration.linearise(conditions, {.cfl = linear_cfl});
  std::vector<Sensitivity> out;
  for (std::size_t begin = 0; begin < problems.size();) {
    const auto group = std::span(problems).subspan(begin, std::min<std::size_t>(3, problems.size() - begin));
    if (group.size() == 3) solve_group<3>(iteration, conditions, group, settings, out);
    if (group.size() == 2) solve_group<2>(iteration, conditions, group, settings, out);
    if (group.size() == 1) solve_group<1>(iteration, conditions, group, settings, out);
    begin += group.size();
  }
  return out;
}

}  // namespace alphadot
