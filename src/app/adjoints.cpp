#include "app/adjoints.hpp"

#include <string_view>
#include <utility>
#include <vector>

#include "app/responses.hpp"
#include "core/log.hpp"

namespace alphadot {

namespace {

constexpr std::string_view prefix = "adjoint_";

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

}  // namespace

Adjoints::Adjoints(FlowCase& flow) : flow_(flow) {
  const auto* restart = flow.checkpoints().restart();
  if (!restart || !is_of_this_flow(*restart, flow)) return;
  const auto cells = static_cast<std::size_t>(flow.setup().domain.owned_cells);
  std::vector<CheckpointField> fields;
  for (const auto& [entry, numbers] : restart->numbers) {
    if (!entry.starts_with(prefix)) continue;
    std::string name = entry.substr(prefix.size());
    auto& adjoint = solved_[name] = adjoint_of(name, numbers, cells);
    fields.push_back({entry, adjoint.field});
  }
  flow.checkpoints().read(fields);
  if (!fields.empty()) spdlog::info("{} adjoints are taken from the checkpoint", fields.size());
}

void Adjoints::save() {
  auto head = flow_.steady_head("adjoint");
  std::vector<CheckpointField> fields;
  for (auto& [name, adjoint] : solved_) {
    const std::string entry = std::string(prefix) + name;
    head.numbers[entry] = numbers_of(adjoint);
    fields.push_back({entry, adjoint.field});
  }
  flow_.save(head, std::move(fields));
}

}  // namespace alphadot
