#include "march/steady.hpp"
#include "march/settings.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace alphadot {

namespace {

constexpr Real smallest_cfl = 1e-3;
/// A residual that grows by more than this in one iteration, or in all, rejects the step.
constexpr Real residual_leap = 5, residual_growth = 1e3;
/// Iterations between linearisations: while the flow takes shape, and once it changes little.
constexpr int early_jacobian_age = 4, late_jacobian_age = 10;
constexpr Real early_orders = 2;
/// Decades after which the flow of a gentle march has taken shape.
constexpr Real shaping_orders = 1;
/// At most so many iterations of first order follow a rejected step, and no more once their residual has
/// dropped to this share.
constexpr int rescue_iterations = 20;
constexpr Real rescued_share = 0.01;
constexpr int most_rejections = 6;
/// The limiter is frozen once the flow has taken shape and so many iterations have not lowered the residual
/// to this share of the lowest; not where Newton-Krylov steps are in vain, which are given up instead.
constexpr int stalled_iterations = 20;
constexpr Real stalled_orders = 1, little_progress = 0.5;
/// A march that has not lowered its residual for as many iterations as it took to reach it, and for so many,
/// is at its end. Smaller steps than those of this CFL number get as many more of them.
constexpr int patience = 150;
constexpr Real bold_cfl = 20;
/// The scheme alone is slow when it has taken so many iterations of second order, and so many for every
/// decade.
constexpr int slow_iterations = 30, slow_iterations_a_decade = 20;
/// Of Newton-Krylov steps: their largest CFL number over the scheme's, its greatest growth in one step, the
/// growth of the residual and the smallest share at which a step is not halved once more, and the steps
/// without progress and those taken back after which they are given up.
constexpr Real krylov_boldness = 1e3, krylov_growth = 10, krylov_leap = 1.2, smallest_share = 0.2;
/// A step that is cut back, be it in one cell, is too bold unless the residual drops by this.
constexpr Real worthwhile_drop = 1.05;
constexpr int krylov_patience = 30, most_krylov_rejections = 4;

/// Size of a density residual that is nothing but round-off: the mass flux through a mean face in double
/// precision.
Real round_off_residual(const ImplicitIteration& iteration, const Conditions<Real>& conditions) {
  const Subdomain& domain = iteration.discretization().domain();
  Real area2 = 0;
  for (Index cell = 0; cell < domain.owned_cells; ++cell) area2 += std::pow(domain.volume[cell], 4.0 / 3);
  const Real mean_area =
      std::sqrt(iteration.communicator().sum(area2) / static_cast<Real>(domain.global_cells));
  const Real speed = norm(velocity(conditions.free_stream) - conditions.grid.velocity);
  return 1e-15 * mean_area * (1 + speed);
}

}  // namespace

namespace {

/// The range of a load over some iterations, component by component.
struct LoadRange {
  Load least, most;
  void begin(const Load& load) { least = most = load; }
  void widen(const Load& load) {
    for (int i = 0; i < 3; ++i) {
      least.force[i] = std::min(least.force[i], load.force[i]);
      least.moment[i] = std::min(least.moment[i], load.moment[i]);
      most.force[i] = std::max(most.force[i], load.force[i]);
      most.moment[i] = std::max(most.moment[i], load.moment[i]);
    }
  }
};

}  // namespace

SteadyResult march_to_steady(ImplicitIteration& iteration, const Conditions<Real>& conditions,
                             const SteadySettings& settings, int order,
                             const std::function<bool(const SteadyProgress&)>& observer,
                             const SteadyState& from, Real early_cfl_max) {
  const bool resumed = from.iteration > 0;
  const Real round_off = round_off_residual(iteration, conditions);
  const Real freeze_orders = iteration.discretization().space().freeze_orders;
  Real cfl = resumed ? from.cfl : settings.cfl_start;
  int rescue = 0;  // iterations of first order that are left
  Real rescue_from = 0;
  int rejections = from.rejections, krylov_rejections = 0;
  KrylovSteps krylov = from.krylov;
  const auto evaluate = [&] {
    iteration.evaluate(conditions, rescue > 0 ? 1 : order);
    return iteration.report();
  };
  iteration.use_krylov(krylov == KrylovSteps::taken ? settings.krylov_directions : 0);
  FlowReport report = evaluate();
  const Real first = resumed ? from.first_residual : report.density_residual;
  Real previous = resumed ? from.previous_residual : first;
  Real lowest = resumed ? from.lowest_residual : first;
  int lowest_at = from.lowest_at;
  Real begun_residual = resumed ? from.begun_residual : first;
  int begun_at = from.begun_at;
  LoadRange range{from.least, from.most};
  if (!resumed) range.begin(report.total);
  int jacobian_age = late_jacobian_age;
  int count = from.iteration;
  const auto orders = [&] { return std::log10(first / std::max(report.density_residual, 1e-300)); };
  const bool is_gentle = early_cfl_max < settings.cfl_max;
  const auto cfl_max = [&] {
    const Real made = is_gentle ? std::max(Real{0}, orders() - shaping_orders) : 0;
    return std::min(settings.cfl_max, early_cfl_max * std::pow(10, made));
  };
  const auto is_steady = [&] {
    return rescue == 0 && report.physical &&
           (report.density_residual <= round_off || orders() >= settings.orders);
  };
  const auto jacobian_is_due = [&] {
    return krylov == KrylovSteps::taken ||
           jacobian_age >= (orders() < early_orders ? early_jacobian_age : late_jacobian_age);
  };
  const auto limiter_is_due = [&] {
    const bool stalled = count - lowest_at >= stalled_iterations && orders() >= stalled_orders;
    return freeze_orders > 0 && rescue == 0 && krylov != KrylovSteps::taken &&
           (orders() >= freeze_orders || stalled);
  };
  const auto has_stalled = [&] {
    const int allowed = static_cast<int>(std::min(patience * std::max(Real{1}, bold_cfl / cfl), 1e9));
    return count - lowest_at >= std::max(allowed, lowest_at);
  };
  const auto is_slow = [&] {
    if (rescue > 0 || order == 1 || (is_gentle && orders() < shaping_orders)) return false;
    if (rejections > 1) return orders() * slow_iterations_a_decade < count;  // bold steps are too bold
    const int made = count - begun_at;
    return made >= slow_iterations && std::log10(begun_residual / previous) * slow_iterations_a_decade < made;
  };
  const auto turn_to = [&](KrylovSteps now) {
    krylov = now;
    iteration.use_krylov(krylov == KrylovSteps::taken ? settings.krylov_directions : 0);
    cfl = std::min(cfl, cfl_max());
    jacobian_age = late_jacobian_age;
    lowest = previous;
    lowest_at = count;
    range.begin(report.total);
  };
  const auto is_worse = [&](Real leap) {
    return !report.physical || report.density_residual > leap * previous ||
           report.density_residual > residual_growth * first;
  };
  const auto ended = [&](RunStatus status) {
    iteration.use_krylov(0);
    const Real reached = orders();
    Real reached_free = reached;
    const bool is_over = status == RunStatus::converged || status == RunStatus::completed;
    if (is_over && iteration.limiter_is_frozen()) {
      const auto factors = iteration.limiter_factors();
      const std::vector<Five<float>> frozen(factors.begin(), factors.end());
      iteration.freeze_limiter(false);
      reached_free = std::log10(first / std::max(evaluate().density_residual, 1e-300));
      std::ranges::copy(frozen, factors.begin());
      iteration.freeze_limiter(true);
      evaluate();
    }
    return SteadyResult{
        status, count, report, reached, reached_free, has_stalled(), range.most - range.least};
  };

  if (is_steady()) return ended(RunStatus::converged);
  while (count < settings.max_iterations) {
    if (jacobian_is_due()) {
      iteration.linearise(conditions, {.cfl = cfl});
      jacobian_age = 0;
    }
    ++jacobian_age;
    bool is_cut = iteration.advance() > 0;  // a Newton-Krylov step, in some cell or in all
    report = evaluate();
    ++count;
    if (krylov == KrylovSteps::taken) {
      is_cut = iteration.communicator().any(is_cut);
      for (Real share = 1; share > smallest_share && is_worse(krylov_leap); share /= 2) {
        iteration.shorten(0.5);
        report = evaluate();
        is_cut = true;
      }
    }
    if (krylov == KrylovSteps::taken && is_worse(krylov_leap)) {
      iteration.undo();
      report = evaluate();
      cfl *= 0.1;
      if (++krylov_rejections > most_krylov_rejections) turn_to(KrylovSteps::given_up);
      continue;
    }
    if (is_worse(residual_leap)) {
      iteration.undo();
      iteration.freeze_limiter(false);
      cfl *= 0.1;
      jacobian_age = late_jacobian_age;
      if (++rejections > most_rejections || cfl < smallest_cfl) return ended(RunStatus::diverged);
      rescue = rescue_iterations;
      report = evaluate();
      previous = rescue_from = report.density_residual;
      continue;
    }
    const Real drop = previous / report.density_residual;
    previous = report.density_residual;
    if (rescue > 0 && (--rescue == 0 || previous < rescued_share * rescue_from)) {
      rescue = 0;
      report = evaluate();  // the second-order residual is another one: no leap
      previous = begun_residual = report.density_residual;
      begun_at = count;
    }
    if (krylov == KrylovSteps::taken && is_cut)
      cfl = drop < worthwhile_drop ? std::max(0.5 * cfl, std::min(cfl, settings.cfl_start)) : cfl;
    else if (krylov == KrylovSteps::taken)
      cfl = std::min(cfl * std::max(settings.cfl_growth, std::min(drop, krylov_growth)),
                     krylov_boldness * settings.cfl_max);
    else
      cfl = std::min(cfl * settings.cfl_growth, cfl_max());
    if (rescue > 0 || previous < little_progress * lowest) {
      lowest = previous;
      lowest_at = count;
      range.begin(report.total);
    } else {
      range.widen(report.total);
    }
    if (limiter_is_due()) iteration.freeze_limiter(true);
    if (settings.krylov_directions > 0 && krylov == KrylovSteps::not_yet && is_slow())
      turn_to(KrylovSteps::taken);
    else if (krylov == KrylovSteps::taken && count - lowest_at >= krylov_patience)
      turn_to(KrylovSteps::given_up);
    const bool go_on = observer({count,
                                 cfl,
                                 orders(),
                                 report,
                                 {count, cfl, first, previous, lowest, lowest_at, begun_residual, begun_at,
                                  rejections, range.least, range.most, krylov},
                                 jacobian_is_due() && rescue == 0});
    if (is_steady()) return ended(RunStatus::converged);
    if (!go_on) return ended(RunStatus::interrupted);
    if (has_stalled()) break;
  }
  return ended(RunStatus::completed);
}

}  // namespace alphadot
