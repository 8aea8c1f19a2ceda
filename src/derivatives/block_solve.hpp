// Several linear problems with one operator on their way to their solutions, forward or transposed.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "core/error.hpp"
#include "derivatives/preconditioner.hpp"
#include "derivatives/settings.hpp"
#include "linear/krylov_basis.hpp"

namespace alphadot {

/// So many problems are solved together.
inline constexpr std::size_t problems_at_a_time = 3;

/// What a solve asks of one of its problems.
struct BlockProblem {
  std::string name;
  Real orders;  ///< decades that its norm is to drop by
  std::span<const Five<Real>> guess = {};
  Real reference_norm = 0;    ///< that the decades count from; 0: the norm at the start
  Real imaginary_weight = 1;  ///< of the defect's imaginary part in its norm
  /// How an error of the guess reaches the functionals is known: it may be good enough as it is.
  bool guess_is_sampled = false;
};

/// The way of one problem to its solution: linear functionals of it (of this rank only) and the norm of the
/// scaled defect, at the start and after every iteration.
struct BlockRecord {
  std::vector<std::vector<Real>> functionals;
  std::vector<Real> norms;
  Real reference_norm = 0;  ///< as of the problem
  Real drop() const {
    return norms.back() / std::max(reference_norm > 0 ? reference_norm : norms.front(), Real{1e-300});
  }
};

/// N problems solved together by block GMRES with the implicit scheme on the right, so that what it makes
/// small is the true residual, or by marching with that scheme. Every application of the operator serves all
/// problems, and all of them look along the directions of all. The operator is a class with
///   parts                                of a field: 1, or 2 when it is complex, the imaginary one second
///   apply(fields, images, with_source)   images = A fields, or A fields + b; [parts * owned_cells] each
///   functionals(k)                       of problem k's field in the latest apply(), of this rank; of a
///                                        complex field first all real parts, then all imaginary ones
///   scale(image, out), unscale(in, out)  D of the norm |D (A U + b)| and its inverse
///   transposed                           Transposed::yes or no, for the preconditioner
///   turn(field, sign)                    of complex fields: to where the preconditioner is to work, and back
template <int N, class Operator>
class BlockSolve {
 public:
  using Field = std::vector<Five<Real>>;
  using Fields = std::array<std::span<const Five<Real>>, N>;
  using Images = std::array<std::span<Five<Real>>, N>;
  static constexpr std::size_t parts = Operator::parts;
  using Scalar = std::conditional_t<parts == 1, Real, std::complex<Real>>;

  BlockSolve(Operator& of, ImplicitIteration& iteration, const Conditions<Real>& conditions,
             std::array<BlockProblem, N> problems, const DerivativeSettings& settings,
             const std::function<bool()>& go_on)
      : operator_(of),
        iteration_(iteration),
        problems_(std::move(problems)),
        settings_(settings),
        go_on_(go_on),
        cells_(static_cast<std::size_t>(iteration.discretization().domain().owned_cells)),
        space_(cells_, settings.directions, [this](std::vector<Real>& numbers) { iteration_.sum(numbers); }),
        conditions_(conditions) {
    for (auto* arrays : {&fields_, &images_, &corrections_, &defects_})
      for (Field& array : *arrays) array.resize(parts * cells_);
    begin();
  }

  /// False when it was stopped. Throws DivergedError when a solution leaves the numbers or a march grows.
  bool solve() {
    evaluate(true);
    settings_.method == SensitivityMethod::march ? march() : gmres();
    return !is_stopped_;
  }

  Field& field(std::size_t k) { return fields_[k]; }
  const BlockRecord& record(std::size_t k) const { return records_[k]; }
  int iterations() const { return iterations_; }

 private:
  void begin() {
    for (std::size_t k = 0; k < N; ++k) {
      std::ranges::fill(fields_[k], Five<Real>{});
      std::ranges::copy(problems_[k].guess, fields_[k].begin());
    }
    records_ = {};
    for (std::size_t k = 0; k < N; ++k) records_[k].reference_norm = problems_[k].reference_norm;
  }

  /// The defects D (A U + b) of all problems at their present fields; functionals and norms into the records,
  /// of a further iteration or, since those of a Krylov space are carried along, in place of the latest.
  void evaluate(bool is_further) {
    operator_.apply(const_spans(fields_), spans(images_), true);
    for (std::size_t k = 0; k < N; ++k) {
      operator_.scale(images_[k], defects_[k]);
      if (!is_further) {
        records_[k].functionals.pop_back();
        records_[k].norms.pop_back();
      }
      records_[k].functionals.push_back(operator_.functionals(k));
    }
    add_norms();
  }

  /// Of the present defects. Collective: one all-reduce.
  void add_norms() {
    std::vector<Real> squares;
    for (std::size_t k = 0; k < N; ++k) {
      const std::span<const Five<Real>> defect(defects_[k]);
      squares.push_back(square(defect.first(cells_)));
      if (parts == 2)
        squares.back() += std::pow(problems_[k].imaginary_weight, 2) * square(defect.last(cells_));
    }
    iteration_.sum(squares);
    for (std::size_t k = 0; k < N; ++k) add_norm(k, std::sqrt(squares[k]));
  }

  void add_norm(std::size_t k, Real norm) {
    records_[k].norms.push_back(norm);
    if (!std::isfinite(norm))
      throw DivergedError("the linear solve for " + problems_[k].name + " came to a norm that is no number");
  }

  static Images spans(std::array<Field, N>& arrays) {
    Images out;
    for (std::size_t k = 0; k < N; ++k) out[k] = arrays[k];
    return out;
  }
  static Fields const_spans(const std::array<Field, N>& arrays) {
    Fields out;
    for (std::size_t k = 0; k < N; ++k) out[k] = arrays[k];
    return out;
  }

  /// corrections_ = -P^-1 (A U + b), from the defects; images_ serves as a buffer.
  void precondition() {
    if (!preconditioner_) preconditioner_.emplace(iteration_, conditions_, Operator::transposed);
    std::array<LinearSystem, parts * N> systems;
    for (std::size_t k = 0; k < N; ++k) {
      operator_.unscale(defects_[k], images_[k]);
      if constexpr (parts == 2) operator_.turn(images_[k], 1);
      for (std::size_t part = 0; part < parts; ++part)
        systems[parts * k + part] = {std::span(images_[k]).subspan(part * cells_, cells_),
                                     std::span(corrections_[k]).subspan(part * cells_, cells_)};
    }
    preconditioner_->solve(systems);
    if constexpr (parts == 2)
      for (Field& correction : corrections_) operator_.turn(correction, -1);
  }

  /// A good guess must improve by a decade too: how its error reaches the functionals shows only then.
  bool all_dropped() const {
    constexpr Real of_guess = 0.1;
    constexpr int fewest = 4;  // from which a rate can be told
    const bool all_sampled = std::ranges::all_of(problems_, &BlockProblem::guess_is_sampled);
    if (!all_sampled && iterations_ < std::min(fewest, settings_.max_iterations) && largest_norm() > 0)
      return false;
    for (std::size_t k = 0; k < N; ++k) {
      const BlockRecord& record = records_[k];
      if (record.drop() > std::pow(10.0, -problems_[k].orders)) return false;
      if (!problems_[k].guess_is_sampled && record.reference_norm > 0 &&
          record.norms.back() > of_guess * record.norms.front())
        return false;
    }
    return true;
  }
  Real largest_norm() const {
    Real out = 0;
    for (const auto& record : records_) out = std::max(out, record.norms.back());
    return out;
  }
  bool is_stopped() {
    is_stopped_ = is_stopped_ || (go_on_ && !go_on_());
    return is_stopped_;
  }

  /// U += -P^-1 (A U + b) until it is steady; from the start again with a gentler preconditioner where that
  /// grows.
  void march() {
    constexpr Real grown = 10;
    for (int count = 1; count <= settings_.max_iterations && !all_dropped(); ++count) {
      precondition();
      ++iterations_;
      for (std::size_t k = 0; k < N; ++k)
        for (std::size_t i = 0; i < corrections_[k].size(); ++i) fields_[k][i] += corrections_[k][i];
      evaluate(true);
      if (is_stopped()) return;
      const auto growing = std::ranges::find_if(records_, [](const auto& r) { return r.drop() > grown; });
      if (growing == records_.end()) continue;
      if (!preconditioner_->can_be_damped())
        throw DivergedError("the march of the response to " +
                            problems_[static_cast<std::size_t>(growing - records_.begin())].name +
                            " grows: the steady state hides an unstable cell");
      preconditioner_->damp();
      begin();
      evaluate(true);
    }
  }

  /// Every iteration looks along what the preconditioner makes of the present defects.
  void gmres() {
    constexpr Real single_precision = 1e-5;  // what directions kept as such can reduce a residual by
    for (int used = 0, at_level = 0; used < settings_.max_iterations && !all_dropped();) {
      if (space_.is_full()) space_.clear();
      const Real cycle_start = largest_norm();
      std::vector<typename KrylovBasis<Scalar>::System> searches;
      for (std::size_t k = 0; k < N; ++k)
        searches.push_back({defects_[k], scalars_of(records_[k].functionals.back()), {}, 0});
      bool stalls = false;
      while (used < settings_.max_iterations && !space_.is_full() && !all_dropped() && !stalls &&
             largest_norm() > single_precision * cycle_start) {
        widen_space();
        space_.reduce(searches);
        for (std::size_t k = 0; k < N; ++k) {
          records_[k].functionals.push_back(reals_of(searches[k].functionals));
          if (parts == 1) add_norm(k, searches[k].norm);
        }
        if (parts == 2) add_norms();
        ++used, ++at_level, ++iterations_;
        if (is_stopped()) return;
        stalls =
            at_level >= static_cast<int>(Preconditioner::stalled_iterations) &&
            preconditioner_->can_be_damped() &&
            std::ranges::any_of(records_, [](const auto& r) { return Preconditioner::has_stalled(r.norms); });
      }
      for (std::size_t k = 0; k < N; ++k) space_.move(fields_[k], searches[k].coefficients);
      if (stalls) {
        preconditioner_->damp();
        at_level = 0;
      }
      evaluate(false);
    }
  }

  void widen_space() {
    precondition();
    operator_.apply(const_spans(corrections_), spans(images_), false);
    std::vector<typename KrylovBasis<Scalar>::Candidate> candidates;
    for (std::size_t k = 0; k < N; ++k) {
      operator_.scale(images_[k], images_[k]);
      candidates.push_back({corrections_[k], images_[k], scalars_of(operator_.functionals(k))});
    }
    space_.add(candidates);
  }

  /// Complex numbers are kept all real parts first, then all imaginary ones.
  static std::vector<Scalar> scalars_of(const std::vector<Real>& reals) {
    if constexpr (parts == 1) {
      return reals;
    } else {
      const std::size_t half = reals.size() / 2;
      std::vector<Scalar> out;
      out.reserve(half);
      for (std::size_t i = 0; i < half; ++i) out.emplace_back(reals[i], reals[half + i]);
      return out;
    }
  }
  static std::vector<Real> reals_of(const std::vector<Scalar>& scalars) {
    std::vector<Real> out;
    out.reserve(parts * scalars.size());
    for (const Scalar scalar : scalars) out.push_back(std::real(scalar));
    if constexpr (parts == 2)
      for (const Scalar scalar : scalars) out.push_back(std::imag(scalar));
    return out;
  }

  Operator& operator_;
  ImplicitIteration& iteration_;
  std::array<BlockProblem, N> problems_;
  DerivativeSettings settings_;
  const std::function<bool()>& go_on_;
  std::size_t cells_;
  KrylovBasis<Scalar> space_;
  const Conditions<Real>& conditions_;
  std::optional<Preconditioner> preconditioner_;  // from the first iteration on
  std::array<BlockRecord, N> records_;
  std::array<Field, N> fields_, images_, corrections_, defects_;
  int iterations_ = 0;
  bool is_stopped_ = false;
};

/// Calls solve(group, std::integral_constant<int, N>) for one group of the problems after the other, until it
/// returns false; so does this then.
template <class Problem, class Solve>
bool in_groups(std::span<const Problem> problems, const Solve& solve) {
  while (!problems.empty()) {
    const auto group = problems.first(std::min(problems_at_a_time, problems.size()));
    const bool goes_on = group.size() == 3   ? solve(group, std::integral_constant<int, 3>{})
                         : group.size() == 2 ? solve(group, std::integral_constant<int, 2>{})
                                             : solve(group, std::integral_constant<int, 1>{});
    if (!goes_on) return false;
    problems = problems.subspan(group.size());
  }
  return true;
}

}  // namespace alphadot
