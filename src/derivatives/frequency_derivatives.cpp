#include "derivatives/frequency_derivatives.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "core/log.hpp"
#include "derivatives/flight_variables.hpp"
#include "derivatives/flow_symmetry.hpp"
#include "derivatives/loads.hpp"

namespace alphadot {

namespace {

/// Variables that are solved for together: on a symmetric body those that answer alike.
std::vector<std::vector<Variable>> oscillating(const Case& settings, bool with_gusts) {
  using enum Variable;
  std::vector<std::vector<Variable>> out{{alpha, q}};
  if (!settings.reference.half_model) out.insert(out.end(), {{beta, r}, {p}});
  if (with_gusts) out.push_back({gust});
  if (with_gusts && !settings.reference.half_model) out.push_back({side_gust});
  return out;
}

Oscillation oscillation_of(Variable variable, const FreestreamSettings& stream) {
  Vec3 gust;
  if (variable == Variable::gust) gust.z = stream.mach;
  if (variable == Variable::side_gust) gust.y = stream.mach;
  return {std::string(name(variable)), change_of(variable, stream), gust};
}

/// One decade better than responses to a constant change: each load is made of two parts.
DerivativeSettings settings_for(DerivativeSettings settings) {
  settings.orders += 1;
  return settings;
}

Frequency frequency_of(Real k, const Case& settings) {
  /// By so much a body's passage is longer than its length of reference takes half of.
  constexpr Real passage = 4;
  return {k * settings.unit_rate(), std::max(Real{1}, 1 / (passage * k))};
}

/// The response of one part of the configuration, a row a coefficient that symmetry leaves.
void add_rows(const std::string& part, Variable variable, Real k, const std::array<Load, 2>& response,
              const std::array<Load, 2>& error, const FlowSymmetry& symmetry, bool converged,
              const Case& settings, std::vector<FrequencyRow>& rows) {
  const Real scale = rate_scale(variable, settings);
  std::array<Coefficients, 2> values, errors;
  for (std::size_t i = 0; i < 2; ++i) {
    values[i] = coefficients(scale * response[i], settings);
    errors[i] = coefficients(scale * error[i], settings);
  }
  for (int c = 0; c < Coefficients::size(); ++c) {
    const auto name = coefficient_names[static_cast<std::size_t>(c)];
    if (settings.reference.half_model && name != "CA" && name != "CN" && name != "Cm") continue;
    for (std::size_t i = 0; i < 2; ++i)
      errors[i][c] = std::abs(errors[i][c]) + (symmetry.makes_zero(c, variable) ? std::abs(values[i][c]) : 0);
    rows.push_back({k,
                    part,
                    std::string(name),
                    variable,
                    {values[0][c], errors[0][c]},
                    {values[1][c] / k, errors[1][c] / k},
                    converged});
  }
}

}  // namespace

void Oscillations::add(Variable variable, Real k, FrequencyResponse response) {
  latest_[variable] = std::move(response.field);
  response.field = {};
  solved_[{k, variable}] = std::move(response);
}

bool solve_oscillations(FlowCase& flow, const std::vector<Real>& frequencies, bool with_gusts,
                        Oscillations& oscillations, const SolveObserver& observer) {
  const Case& settings = flow.settings();
  for (const auto& group : oscillating(settings, with_gusts)) {
    std::vector<Real> open;
    std::vector<Frequency> asked;
    for (const Real k : frequencies) {
      if (std::ranges::all_of(group, [&](Variable variable) { return oscillations.has(variable, k); }))
        continue;
      open.push_back(k);
      asked.push_back(frequency_of(k, settings));
    }
    if (open.empty()) continue;
    std::vector<Oscillation> sources;
    for (const auto variable : group) sources.push_back(oscillation_of(variable, settings.freestream));
    FrequencySolver solver(flow.iteration(), flow.conditions(), settings_for(settings.derivatives), sources,
                           steady_error(flow.steady_orders()), observer.go_on);
    for (const auto variable : group)
      if (const auto known = oscillations.latest().find(variable); known != oscillations.latest().end())
        solver.know(known->second);
    bool is_kept = true;  // in a checkpoint, which one is made for what took some work
    const auto take = [&](std::size_t number, std::vector<FrequencyResponse> responses) {
      const Real k = open[number];
      const int iterations = responses.front().iterations;
      for (std::size_t i = 0; i < group.size(); ++i) {
        spdlog::info("k = {:<8g} {:6} {:3} iterations, linear residual {:.1e}", k, name(group[i]), iterations,
                     responses[i].relative_residual);
        oscillations.add(group[i], k, std::move(responses[i]));
      }
      is_kept = iterations > 0;
      if (observer.solved && is_kept) observer.solved();
    };
    if (!solver.solve(asked, take)) return false;
    if (observer.solved && !is_kept) observer.solved();
  }
  return true;
}

std::vector<FrequencyRow> frequency_rows(const FlowCase& flow, const std::vector<Real>& frequencies,
                                         bool with_gusts, const Oscillations& oscillations,
                                         std::vector<std::string>& shortfalls) {
  const Case& settings = flow.settings();
  const bool is_deep = flow.steady_orders() >= deep_steady_orders;
  if (!is_deep)
    shortfalls.push_back(fmt::format("responses are of a flow {:.1f} decades down, and need {:g}",
                                     flow.steady_orders(), deep_steady_orders));
  std::vector<FrequencyRow> rows;
  std::vector<Variable> variables;
  for (const auto& group : oscillating(settings, with_gusts))
    variables.insert(variables.end(), group.begin(), group.end());
  for (const Real k : frequencies)
    for (const auto variable : variables) {
      const auto& response = oscillations.at(variable, k);
      auto shortfall =
          shortfall_of_solve(fmt::format("{} at k = {:g}", name(variable), k), response.relative_residual,
                             response.iterations, settings.derivatives.orders);
      const bool converged = shortfall.empty() && is_deep;
      if (!shortfall.empty()) shortfalls.push_back(std::move(shortfall));
      add_rows("total", variable, k, response.total, response.total_error, symmetry_of({}, flow, settings),
               converged, settings, rows);
      const auto& patches = flow.setup().domain.patch_names;
      for (std::size_t patch = 0; patch < response.loads[0].size(); ++patch)
        if (settings.boundary.at(patches[patch]) == BoundaryKind::wall)
          add_rows(patches[patch], variable, k, {response.loads[0][patch], response.loads[1][patch]},
                   {response.loads_error[0][patch], response.loads_error[1][patch]},
                   symmetry_of({std::span(&patches[patch], 1), patches}, flow, settings), converged, settings,
                   rows);
    }
  return rows;
}

}  // namespace alphadot
