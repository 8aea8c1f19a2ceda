#include "app/responses.hpp"

#include <span>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "core/log.hpp"

namespace alphadot {

namespace {

constexpr Variable solved_for[] = {Variable::alpha,   Variable::beta,      Variable::p,
                                   Variable::q,       Variable::r,         Variable::alphadot,
                                   Variable::betadot, Variable::alphaddot, Variable::betaddot};

std::string entry_of(ResponseKey key) {
  return (key.limiter_held ? "response_limiter_held_" : "response_") + std::string(name(key.variable));
}

/// What a checkpoint keeps of a response besides its field.
std::vector<Real> numbers_of(const Sensitivity& response) {
  std::vector<Load> loads{response.total, response.total_error};
  loads.insert(loads.end(), response.loads.begin(), response.loads.end());
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
  out.loads.assign(loads.begin() + 2, loads.end());
  return out;
}

}  // namespace

bool is_of_this_flow(const CheckpointHead& head, const FlowCase& flow) {
  const auto now = flow.steady_head("");
  for (const char* entry : {"iteration", "cfl", "residuals"})
    if (head.numbers.at(entry) != now.numbers.at(entry)) return false;
  const auto tolerances = [](const DerivativeSettings& settings) {
    return std::tie(settings.method, settings.orders, settings.directions, settings.max_iterations);
  };
  return tolerances(flow.checkpoints().case_before().derivatives) == tolerances(flow.settings().derivatives);
}

Responses::Responses(FlowCase& flow) : flow_(flow) {
  const auto* restart = flow.checkpoints().restart();
  if (!restart || !is_of_this_flow(*restart, flow)) return;
  const auto cells = static_cast<std::size_t>(flow.setup().domain.owned_cells);
  std::vector<CheckpointField> fields;
  for (const bool limiter_held : {false, true})
    for (const auto variable : solved_for) {
      const ResponseKey key{variable, limiter_held};
      const auto numbers = restart->numbers.find(entry_of(key));
      if (numbers == restart->numbers.end()) continue;
      auto& response = solved_[key] = response_of(variable, numbers->second, cells);
      fields.push_back({entry_of(key), response.field});
    }
  flow.checkpoints().read(fields);
  if (!fields.empty()) spdlog::info("{} linear solves are taken from the checkpoint", fields.size());
}

void Responses::save() {
  auto head = flow_.steady_head("derivatives");
  std::vector<CheckpointField> fields;
  for (auto& [key, response] : solved_) {
    head.numbers[entry_of(key)] = numbers_of(response);
    fields.push_back({entry_of(key), response.field});
  }
  flow_.save(head, std::move(fields));
}

}  // namespace alphadot
