#include "app/oscillations.hpp"

#include <fmt/format.h>

#include <array>
#include <span>
#include <string>
#include <utility>

#include "app/responses.hpp"
#include "core/log.hpp"

namespace alphadot {

namespace {

constexpr std::array oscillating{Variable::alpha, Variable::beta, Variable::p, Variable::q, Variable::r};

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
std::pair<Real, FrequencyResponse> response_of(std::span<const Real> numbers) {
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

}  // namespace

Oscillations::Oscillations(FlowCase& flow) : flow_(flow) {
  const auto* restart = flow.checkpoints().restart();
  if (!restart || !is_of_this_flow(*restart, flow)) return;
  const auto cells = static_cast<std::size_t>(flow.setup().domain.owned_cells);
  std::vector<CheckpointField> fields;
  for (const auto variable : oscillating) {
    for (int count = 0;; ++count) {
      const auto numbers = restart->numbers.find(entry_of(variable, std::to_string(count)));
      if (numbers == restart->numbers.end()) break;
      auto [k, response] = response_of(numbers->second);
      solved_[{k, variable}] = std::move(response);
      latest_[variable].k = k;
    }
    const auto latest = latest_.find(variable);
    if (latest == latest_.end()) continue;
    for (auto* part : {&latest->second.real, &latest->second.imaginary}) part->resize(cells);
    fields.push_back({entry_of(variable, "real"), latest->second.real});
    fields.push_back({entry_of(variable, "imaginary"), latest->second.imaginary});
  }
  flow.checkpoints().read(fields);
  if (!solved_.empty()) spdlog::info("{} linear solves are taken from the checkpoint", solved_.size());
}

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

void Oscillations::save() {
  auto head = flow_.steady_head("frequency");
  std::map<Variable, int> count;
  for (const auto& [key, response] : solved_)
    head.numbers[entry_of(key.variable, std::to_string(count[key.variable]++))] = numbers_of(key.k, response);
  std::vector<CheckpointField> fields;
  for (auto& [variable, latest] : latest_) {
    fields.push_back({entry_of(variable, "real"), latest.real});
    fields.push_back({entry_of(variable, "imaginary"), latest.imaginary});
  }
  flow_.save(head, std::move(fields));
}

}  // namespace alphadot
