#include "app/kept_solutions.hpp"

#include <fmt/format.h>

#include <map>
#include <span>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

#include "core/log.hpp"
#include "derivatives/controls.hpp"

namespace alphadot {

namespace {

/// All that a case may be solved for.
std::vector<Variable> solved_for(const Case& settings) {
  using enum Variable;
  std::vector<Variable> out{alpha, beta, p, q, r, alphadot, betadot, alphaddot, betaddot};
  for (const auto& controls : {controls_of(settings), control_rates_of(settings)})
    out.insert(out.end(), controls.begin(), controls.end());
  return out;
}

std::string entry_of(ResponseKey key) {
  return (key.limiter_held ? "response_limiter_held_" : "response_") + std::string(name(key.variable));
}

/// What a checkpoint keeps of a response besides its field.
std::vector<Real> numbers_of(const Sensitivity& response) {
  std::vector<Load> loads{response.total, response.total_error};
  for (const auto* of_patches : {&response.loads, &response.loads_error})
    loads.insert(loads.end(), of_patches->begin(), of_patches->end());
  auto out = numbers_of(loads);
  out.insert(out.end(),
             {static_cast<Real>(response.iterations), response.relative_error, response.relative_residual});
  return out;
}

/// The way back; the field has zeros.
Sensitivity response_of(Variable variable, const std::vector<Real>& numbers, std::size_t cells) {
  const auto loads = loads_of(std::span(numbers).first(numbers.size() - 3));
  Sensitivity out;
  out.name = name(variable);
  out.field.resize(cells);
  out.iterations = static_cast<int>(numbers[numbers.size() - 3]);
  out.relative_error = numbers[numbers.size() - 2];
  out.relative_residual = numbers.back();
  out.total = loads.at(0);
  out.total_error = loads.at(1);
  const auto patches = loads.begin() + 2, errors = patches + (loads.end() - patches) / 2;
  out.loads.assign(patches, errors);
  out.loads_error.assign(errors, loads.end());
  return out;
}

constexpr std::string_view adjoint_prefix = "adjoint_";

/// What a checkpoint keeps of an adjoint besides its field.
std::vector<Real> numbers_of(const Adjoint& adjoint) {
  std::vector<Real> out{static_cast<Real>(adjoint.iterations), adjoint.relative_error,
                        adjoint.relative_residual};
  for (const auto& change : {adjoint.sensitivity, adjoint.sensitivity_error})
    for (const Vec3& part : {change.wind, change.grid_velocity, change.rotation})
      out.insert(out.end(), {part.x, part.y, part.z});
  for (const auto& products : {adjoint.products, adjoint.products_error})
    out.insert(out.end(), products.begin(), products.end());
  return out;
}

/// The way back; the field has zeros.
Adjoint adjoint_of(std::string name, const std::vector<Real>& numbers, std::size_t cells) {
  Adjoint out;
  out.name = std::move(name);
  out.field.resize(cells);
  out.iterations = static_cast<int>(numbers.at(0));
  out.relative_error = numbers.at(1);
  out.relative_residual = numbers.at(2);
  auto next = numbers.begin() + 3;
  for (auto* change : {&out.sensitivity, &out.sensitivity_error})
    for (Vec3* part : {&change->wind, &change->grid_velocity, &change->rotation})
      for (int axis = 0; axis < 3; ++axis) (*part)[axis] = *next++;
  const auto products = (numbers.end() - next) / 2;
  out.products.assign(next, next + products);
  out.products_error.assign(next + products, numbers.end());
  return out;
}

constexpr Variable oscillating[] = {Variable::alpha, Variable::beta, Variable::p,        Variable::q,
                                    Variable::r,     Variable::gust, Variable::side_gust};

std::string entry_of(Variable variable, std::string_view what) {
  return fmt::format("oscillation_{}_{}", name(variable), what);
}

/// What a checkpoint keeps of a response besides its field.
std::vector<Real> numbers_of(Real k, const FrequencyResponse& response) {
  std::vector<Real> out{k, response.relative_residual, static_cast<Real>(response.iterations)};
  const auto add = [&](std::span<const Load> loads) {
    const auto numbers = numbers_of(loads);
    out.insert(out.end(), numbers.begin(), numbers.end());
  };
  add(response.total);
  add(response.total_error);
  for (const auto* loads : {&response.loads, &response.loads_error})
    for (const auto& part : *loads) add(part);
  return out;
}

/// The way back, with k.
std::pair<Real, FrequencyResponse> oscillation_of(std::span<const Real> numbers) {
  FrequencyResponse out;
  out.relative_residual = numbers[1];
  out.iterations = static_cast<int>(numbers[2]);
  const auto loads = loads_of(numbers.subspan(3));
  out.total = {loads.at(0), loads.at(1)};
  out.total_error = {loads.at(2), loads.at(3)};
  const auto patches = static_cast<std::ptrdiff_t>((loads.size() - 4) / 4);
  auto next = loads.begin() + 4;
  for (auto* of_patches : {&out.loads, &out.loads_error})
    for (auto& part : *of_patches) {
      part.assign(next, next + patches);
      next += patches;
    }
  return {numbers[0], std::move(out)};
}

/// The checkpoint that the run goes on from, when its solutions are about the flow that the run has marched
/// to, under the same [derivatives].
const CheckpointHead* head_of_solutions(const CaseRun& run) {
  const auto* restart = run.checkpoints().restart();
  if (!restart) return nullptr;
  const auto now = run.contents().steady_head("");
  for (const char* entry : {"iteration", "cfl", "residuals"})
    if (restart->numbers.at(entry) != now.numbers.at(entry)) return nullptr;
  const auto tolerances = [](const DerivativeSettings& settings) {
    return std::tie(settings.method, settings.orders, settings.directions, settings.max_iterations);
  };
  const auto& before = run.checkpoints().case_before();
  const bool same = tolerances(before.derivatives) == tolerances(run.settings().derivatives) &&
                    before.controls == run.settings().controls;
  return same ? restart : nullptr;
}

/// Reads the fields of so many solutions.
void take(CaseRun& run, const std::vector<CheckpointField>& fields, std::size_t solutions, const char* what) {
  run.checkpoints().read(fields);
  if (solutions > 0) spdlog::info("{} {} are taken from the checkpoint", solutions, what);
}

/// Writes a checkpoint of solutions by a key, each with its field.
template <class Solutions, class EntryOf>
void keep_with_fields(CaseRun& run, const char* phase, Solutions& solutions, const EntryOf& entry_of_key) {
  auto head = run.contents().steady_head(phase);
  std::vector<CheckpointField> fields;
  for (auto& [key, solution] : solutions) {
    const std::string entry = entry_of_key(key);
    head.numbers[entry] = numbers_of(solution);
    fields.push_back({entry, solution.field});
  }
  run.contents().save(head, std::move(fields));
}

}  // namespace

LinearSolves::LinearSolves(CaseRun& run, std::function<void()> save)
    : observer_{[this, &run] {
                  ++iterations_;
                  return !run.checkpoints().request(false).stop;
                },
                std::move(save)},
      watchdog_(
          run.settings().checkpoint.watchdog_minutes, [this] { return iterations_.load(); },
          run.communicator()) {}

Responses kept_responses(CaseRun& run) {
  Responses out;
  const auto* restart = head_of_solutions(run);
  if (!restart) return out;
  const auto cells = static_cast<std::size_t>(run.flow().setup().domain.owned_cells);
  std::vector<CheckpointField> fields;
  for (const bool limiter_held : {false, true})
    for (const auto variable : solved_for(run.settings())) {
      const ResponseKey key{variable, limiter_held};
      const auto numbers = restart->numbers.find(entry_of(key));
      if (numbers == restart->numbers.end()) continue;
      auto& response = out[key] = response_of(variable, numbers->second, cells);
      fields.push_back({entry_of(key), response.field});
    }
  take(run, fields, fields.size(), "linear solves");
  return out;
}

Adjoints kept_adjoints(CaseRun& run) {
  Adjoints out;
  const auto* restart = head_of_solutions(run);
  if (!restart) return out;
  const auto cells = static_cast<std::size_t>(run.flow().setup().domain.owned_cells);
  std::vector<CheckpointField> fields;
  for (const auto& [entry, numbers] : restart->numbers) {
    if (!entry.starts_with(adjoint_prefix)) continue;
    std::string name = entry.substr(adjoint_prefix.size());
    auto& adjoint = out[name] = adjoint_of(name, numbers, cells);
    fields.push_back({entry, adjoint.field});
  }
  take(run, fields, fields.size(), "adjoints");
  return out;
}

Oscillations kept_oscillations(CaseRun& run) {
  Oscillations out;
  const auto* restart = head_of_solutions(run);
  if (!restart) return out;
  const auto cells = static_cast<std::size_t>(run.flow().setup().domain.owned_cells);
  std::vector<CheckpointField> fields;
  for (const auto variable : oscillating) {
    for (int count = 0;; ++count) {
      const auto numbers = restart->numbers.find(entry_of(variable, std::to_string(count)));
      if (numbers == restart->numbers.end()) break;
      auto [k, response] = oscillation_of(numbers->second);
      out.put_back({k, variable}, std::move(response));
    }
    if (!restart->numbers.contains(entry_of(variable, "0"))) continue;
    auto& latest = out.latest()[variable];
    latest.resize(2 * cells);
    fields.push_back({entry_of(variable, "real"), std::span(latest).first(cells)});
    fields.push_back({entry_of(variable, "imaginary"), std::span(latest).last(cells)});
  }
  take(run, fields, out.solved().size(), "linear solves");
  return out;
}

void keep(CaseRun& run, Oscillations& oscillations) {
  auto head = run.contents().steady_head("frequency");
  std::map<Variable, int> count;
  for (const auto& [key, response] : oscillations.solved())
    head.numbers[entry_of(key.variable, std::to_string(count[key.variable]++))] = numbers_of(key.k, response);
  std::vector<CheckpointField> fields;
  for (auto& [variable, latest] : oscillations.latest()) {
    const auto cells = latest.size() / 2;
    fields.push_back({entry_of(variable, "real"), std::span(latest).first(cells)});
    fields.push_back({entry_of(variable, "imaginary"), std::span(latest).last(cells)});
  }
  run.contents().save(head, std::move(fields));
}

void keep(CaseRun& run, Responses& responses) {
  keep_with_fields(run, "derivatives", responses, [](ResponseKey key) { return entry_of(key); });
}

void keep(CaseRun& run, Adjoints& adjoints) {
  keep_with_fields(run, "adjoint", adjoints,
                   [](const std::string& name) { return std::string(adjoint_prefix) + name; });
}

}  // namespace alphadot
