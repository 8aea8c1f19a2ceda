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

std::vector<Variable> oscillating(const Case& settings) {
  using enum Variable;
  if (settings.reference.half_model) return {alpha, q};
  return {alpha, q, beta, p, r};
}

/// Decades for a response at k: its part in phase with the rate is k times smaller than the other, and as
/// many decades better is it solved for, and one more.
DerivativeSettings settings_at(Real k, DerivativeSettings settings) {
  settings.orders += 1 + std::max(Real{0}, -std::log10(k));
  return settings;
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

std::vector<Primitive<Real>> Oscillations::guess(Variable variable, Real k) const {
  const auto latest = latest_.find(variable);
  if (latest == latest_.end()) return {};
  auto out = latest->second.real;
  for (const auto& w : latest->second.imaginary) out.push_back(k / latest->second.k * w);
  return out;
}

void Oscillations::add(Variable variable, Real k, FrequencyResponse response) {
  const auto middle = response.field.begin() + static_cast<std::ptrdiff_t>(response.field.size() / 2);
  latest_[variable] = {k, {response.field.begin(), middle}, {middle, response.field.end()}};
  response.field = {};
  solved_[{k, variable}] = std::move(response);
}

bool solve_oscillations(FlowCase& flow, const std::vector<Real>& frequencies, Oscillations& oscillations,
                        const SolveObserver& observer) {
  const Case& settings = flow.settings();
  for (const Real k : frequencies) {
    FrequencySolver solver(flow.iteration(), flow.conditions(), settings_at(k, settings.derivatives),
                           observer.go_on);
    for (const auto variable : oscillating(settings)) {
      if (oscillations.has(variable, k)) continue;
      const auto guess = oscillations.guess(variable, k);
      FrequencyResponse response;
      if (!solver.solve(
              {fmt::format("{} at k = {:g}", name(variable), k), change_of(variable, settings.freestream),
               k * 2 * settings.freestream.mach / settings.reference.length, guess,
               steady_error(flow.steady_orders())},
              response))
        return false;
      spdlog::info("k = {:<8g} {:6} {:3} iterations, linear residual {:.1e}", k, name(variable),
                   response.iterations, response.relative_residual);
      oscillations.add(variable, k, std::move(response));
      if (observer.solved) observer.solved();
    }
  }
  return true;
}

std::vector<FrequencyRow> frequency_rows(const FlowCase& flow, const std::vector<Real>& frequencies,
                                         const Oscillations& oscillations,
                                         std::vector<std::string>& shortfalls) {
  const Case& settings = flow.settings();
  const bool is_deep = flow.steady_orders() >= deep_steady_orders;
  if (!is_deep)
    shortfalls.push_back(fmt::format("responses are of a flow {:.1f} decades down, and need {:g}",
                                     flow.steady_orders(), deep_steady_orders));
  std::vector<FrequencyRow> rows;
  for (const Real k : frequencies)
    for (const auto variable : oscillating(settings)) {
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
