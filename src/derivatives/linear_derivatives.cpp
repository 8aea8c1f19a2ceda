#include "derivatives/linear_derivatives.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "core/log.hpp"
#include "derivatives/controls.hpp"
#include "derivatives/flight_variables.hpp"
#include "derivatives/flow_symmetry.hpp"
#include "derivatives/load_distributions.hpp"
#include "derivatives/loads.hpp"
#include "derivatives/part.hpp"
#include "derivatives/sensitivity.hpp"
#include "derivatives/steady_error.hpp"

namespace alphadot {

namespace {

/// Solves for all variables but those that have been solved for, and says of each how that went. False when
/// the observer ended it.
bool solve_all(FlowCase& flow, SensitivitySolver& solver, Responses& responses, bool limiter_held,
               const SolveObserver& observer, LinearDerivatives& out) {
  if (limiter_held) {
    spdlog::info("once more with the limiter's factors held");
    solver.hold_limiter();
  }
  auto& unconverged = out.estimated.unconverged;
  for (const auto& group : groups_of(flow.settings())) {
    if (!responses.contains({group.front(), limiter_held})) {
      auto solved = solve_group(solver, group, limiter_held, flow, responses);
      if (solved.empty()) return false;
      for (std::size_t i = 0; i < group.size(); ++i)
        responses[{group[i], limiter_held}] = std::move(solved[i]);
      if (observer.solved) observer.solved();
    }
    for (const auto variable : group) {
      const auto& solution = responses.at({variable, limiter_held});
      spdlog::info("{:9} {:3} iterations, linear residual {:.1e}", name(variable), solution.iterations,
                   solution.relative_residual);
      auto shortfall = shortfall_of_solve(name(variable), solution.relative_residual, solution.iterations,
                                          flow.settings().derivatives.orders);
      if (const auto angle = rate_of(variable); !shortfall.empty() || (angle && unconverged.contains(*angle)))
        unconverged.insert(variable);
      if (!shortfall.empty()) out.shortfalls.push_back(std::move(shortfall));
    }
  }
  for (const auto variable : variables_of(flow.settings()))
    for (const auto& [term, weight] : terms_of(variable, flow.settings()))
      if (unconverged.contains(term)) unconverged.insert(variable);
  return true;
}

/// For what a step of Newton's method leaves to the next, also of a component that it happens not to move:
/// shown to hold from one decade on.
constexpr Real step_safety = 5, of_other_components = 0.3;

/// What is large beside a column of derivatives. Forces and moments count alike with an arm between them that
/// is the body's size, `arm` reference lengths, so that no choice of these matters.
Coefficients largest_of(const Coefficients& column, Real arm) {
  const Coefficients unit{1, 1, 1, arm, arm, arm};
  Real largest = 0;
  for (int i = 0; i < column.size(); ++i) largest = std::max(largest, std::abs(column[i]) / unit[i]);
  return largest * unit;
}

/// The responses of the flow that is one step of Newton's method nearer to the steady one, without their
/// fields. Empty when the run was stopped.
Responses solve_nearer(FlowCase& flow, SensitivitySolver& solver, const Responses& responses,
                       const std::function<bool()>& go_on) {
  spdlog::info("once more about a flow one step of Newton's method nearer to the steady one");
  const NewtonStep step(flow.iteration(), flow.conditions(), solver);
  if (step.was_stopped()) return {};
  auto settings = flow.settings().derivatives;
  settings.orders = 1;  // of a small difference
  SensitivitySolver better(flow.iteration(), flow.conditions(), settings, go_on);
  Responses out;
  for (const auto& group : groups_of(flow.settings())) {
    auto changed = solve_group(better, group, false, flow, out, &responses);
    if (changed.empty()) return {};
    for (std::size_t i = 0; i < group.size(); ++i) out[{group[i]}] = std::move(changed[i]);
  }
  for (auto& [key, response] : out) response.field = {};
  return out;
}

/// What the responses say of parts of the configuration.
class Estimation {
 public:
  /// `nearer`: the responses of a flow nearer to the steady one, or none when the flow is a steady one by its
  /// decades. `arm`: between forces and moments, in reference lengths.
  Estimation(const FlowCase& flow, const Responses& responses, const Responses& nearer, Real arm)
      : flow_(flow), responses_(responses), nearer_(nearer), arm_(arm) {}

  /// Of a part, with the coefficients of `settings`, and the uncertainties with their parts.
  EstimatedDerivatives of(const Part& part, const FlightCondition& settings) const {
    EstimatedDerivatives out;
    UncertaintyPart linear{"linear", {}}, steady{"steady", {}}, limiter{"limiter", {}};
    const bool has_limiter = flow_.settings().derivatives.limiter_uncertainty;
    for (const auto variable : variables_of(flow_.settings())) {
      const auto& column = out.derivatives[variable] = column_of(variable, responses_, part, settings);
      for (int i = 0; i < column.size(); ++i) linear.half_width[variable][i] = column[i].uncertainty;
      for (const auto& [term, weight] : terms_of(variable, flow_.settings()))
        steady.half_width[variable] += std::abs(weight) * steady_half_width(term, part, settings);
      if (has_limiter)
        limiter.half_width[variable] = change(column, column_of(variable, responses_, part, settings, true));
    }
    out.parts.push_back(std::move(linear));
    out.add(steady.source, std::move(steady.half_width));
    if (has_limiter) out.add(limiter.source, std::move(limiter.half_width));
    add_symmetry(out, part, settings);
    return out;
  }

 private:
  /// Where the whole flow is symmetric: what is zero of the part itself, and elsewhere as much as of the
  /// whole.
  void add_symmetry(EstimatedDerivatives& out, const Part& part, const FlightCondition& settings) const {
    const auto of_whole = symmetry_of({}, flow_, flow_.settings());
    if (!of_whole.is_any()) return;
    const auto of_part = symmetry_of(part, flow_, settings);
    DerivativeSetOf<Real> half_width;
    for (const auto& [variable, column] : out.derivatives) {
      const auto whole = column_of(variable, responses_, {}, settings);
      for (int i = 0; i < column.size(); ++i)
        half_width[variable][i] = of_part.makes_zero(i, variable)    ? std::abs(column[i].value)
                                  : of_whole.makes_zero(i, variable) ? std::abs(whole[i].value)
                                                                     : 0;
    }
    out.add(std::string(symmetry_part), std::move(half_width));
  }

  /// Of a set of controls the sum.
  CoefficientsOf<Estimate> column_of(Variable variable, const Responses& responses, const Part& part,
                                     const FlightCondition& settings, bool limiter_held = false) const {
    const Real scale = rate_scale(variable, settings);
    CoefficientsOf<Estimate> out;
    for (const auto& [term, weight] : terms_of(variable, flow_.settings())) {
      const auto& solution = responses.at({term, limiter_held});
      const auto values = coefficients(weight * scale * part.of(solution.loads, solution.total), settings);
      const auto errors =
          coefficients(weight * scale * part.of(solution.loads_error, solution.total_error), settings);
      for (int i = 0; i < out.size(); ++i) out[i] = out[i] + Estimate{values[i], std::abs(errors[i])};
    }
    return out;
  }

  static Coefficients change(const CoefficientsOf<Estimate>& before, const CoefficientsOf<Estimate>& after) {
    Coefficients out;
    for (int i = 0; i < out.size(); ++i) out[i] = std::abs(after[i].value - before[i].value);
    return out;
  }

  /// What the steady residual still does: a share of what is large in the variable's column of the whole, or
  /// by how much the column changes in the flow that is nearer to the steady one.
  Coefficients steady_half_width(Variable variable, const Part& part, const FlightCondition& settings) const {
    const auto column = column_of(variable, responses_, part, settings),
               whole = column_of(variable, responses_, {}, settings);
    Coefficients out;
    if (nearer_.empty()) {
      out = steady_error(flow_.steady_orders()) * largest_of(change({}, whole), arm_);
    } else {
      const auto largest = largest_of(change(whole, column_of(variable, nearer_, {}, settings)), arm_);
      out = step_safety *
            (change(column, column_of(variable, nearer_, part, settings)) + of_other_components * largest);
    }
    if (settings.reference.half_model) out.CY = out.Cl = out.Cn = 0;  // the mirror image cancels them
    return out;
  }

  const FlowCase& flow_;
  const Responses &responses_, &nearer_;
  Real arm_;
};

/// What each wall, and each set of walls that the case names, contributes.
std::vector<ComponentDerivatives> component_derivatives(const FlowCase& flow, const Estimation& estimation) {
  const Case& settings = flow.settings();
  std::vector<ComponentDerivatives> out;
  for (const auto& [name, walls] : components_of(settings)) {
    const Part part(walls, flow.setup().domain.patch_names);
    out.push_back({name, walls, estimation.of(part, settings), {}});
    if (settings.reference.half_model) out.back().one_side = estimation.of(part, of_one_side(settings));
  }
  return out;
}

/// What each panel that turns contributes, by itself.
std::vector<PanelDerivatives> panel_derivatives(const FlowCase& flow, const Estimation& estimation) {
  const Case& settings = flow.settings();
  std::vector<PanelDerivatives> out;
  for (const auto& control : settings.controls)
    out.push_back({control.name, frame_of(control),
                   estimation.of({control.patches, flow.setup().domain.patch_names}, of_one_side(settings))});
  return out;
}

}  // namespace

Real steady_error(Real steady_orders) {
  constexpr Real lost_decades = 3;  // by which a derivative may be worse converged than its flow
  return std::pow(10.0, lost_decades - steady_orders);
}

std::string shortfall_of_solve(std::string_view what, Real relative_residual, int iterations, Real orders) {
  if (relative_residual <= std::pow(10.0, -orders)) return {};
  return fmt::format("the linear residual for {} dropped {:.1f} of {:g} decades in {} iterations", what,
                     -std::log10(relative_residual), orders, iterations);
}

bool solve_responses(FlowCase& flow, Responses& responses, std::vector<std::string>& shortfalls,
                     const SolveObserver& observer) {
  SensitivitySolver solver(flow.iteration(), flow.conditions(), flow.settings().derivatives, observer.go_on);
  LinearDerivatives of_solves;
  const bool is_done = solve_all(flow, solver, responses, false, observer, of_solves);
  shortfalls = std::move(of_solves.shortfalls);
  return is_done;
}

LinearDerivatives linear_derivatives(FlowCase& flow, Responses& responses, const SolveObserver& observer) {
  const auto& settings = flow.settings().derivatives;
  SensitivitySolver solver(flow.iteration(), flow.conditions(), settings, observer.go_on);
  LinearDerivatives out;
  const auto ended = [&] {
    LinearDerivatives nothing;
    nothing.shortfalls = std::move(out.shortfalls);
    return nothing;
  };
  if (!solve_all(flow, solver, responses, false, observer, out)) return ended();
  Responses nearer;
  if (flow.steady_orders() < deep_steady_orders) {
    nearer = solve_nearer(flow, solver, responses, observer.go_on);
    if (nearer.empty()) return ended();
  }
  if (const auto& output = flow.settings().output; output.stations > 0 || output.surface) {
    const LoadDistributions distributions(flow, solver, responses);
    if (output.stations > 0) {
      out.along_body = distributions.along_body();
      out.along_panels = distributions.along_panels();
    }
    if (output.surface) out.pressures = distributions.pressures();
  }
  if (settings.limiter_uncertainty && !solve_all(flow, solver, responses, true, observer, out))
    return ended();
  const Estimation estimation(flow, responses, nearer, solver.body_size() / flow.settings().reference.length);
  auto unconverged = std::move(out.estimated.unconverged);
  out.estimated = estimation.of({}, flow.settings());
  out.estimated.unconverged = std::move(unconverged);
  out.components = component_derivatives(flow, estimation);
  out.panels = panel_derivatives(flow, estimation);
  return out;
}

}  // namespace alphadot
