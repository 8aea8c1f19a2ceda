#include "app/flow_checkpoint.hpp"

#include <array>
#include <utility>

#include "case_file/history_info.hpp"

namespace alphadot {

std::vector<Five<Real>> FlowCheckpoint::frozen_factors() const {
  std::vector<Five<Real>> out;
  auto& iteration = flow_.iteration();
  if (iteration.limiter_is_frozen())
    for (const auto& factors : iteration.limiter_factors()) {
      auto& cell = out.emplace_back();
      for (int k = 0; k < 5; ++k) cell[k] = factors[k];
    }
  return out;
}

void FlowCheckpoint::save(const CheckpointHead& head, std::vector<CheckpointField> others) {
  auto& iteration = flow_.iteration();
  auto factors = frozen_factors();
  others.push_back({"flow", iteration.flow().values()});
  if (iteration.limiter_is_frozen()) others.push_back({"limiter_factors", factors});
  checkpoints_.save(head, others);
}

void FlowCheckpoint::restore(std::vector<CheckpointField> others) {
  auto& iteration = flow_.iteration();
  const auto& numbers = checkpoints_.restart()->numbers;
  flow_.set_limiter_threshold(numbers.at("limiter_threshold").at(0));
  iteration.freeze_limiter(numbers.at("limiter_is_frozen").at(0) != 0);
  auto factors = frozen_factors();
  others.push_back({"flow", iteration.flow().values()});
  if (iteration.limiter_is_frozen()) others.push_back({"limiter_factors", factors});
  checkpoints_.read(others);
  for (std::size_t cell = 0; cell < factors.size(); ++cell)
    for (int k = 0; k < 5; ++k) iteration.limiter_factors()[cell][k] = static_cast<float>(factors[cell][k]);
}

CheckpointHead FlowCheckpoint::head(std::string phase) const {
  const Setup& setup = flow_.setup();
  CheckpointHead out;
  out.phase = std::move(phase);
  out.message = record_.kept_message();
  out.history.info = history_info(flow_.settings(), setup.mesh.hash, setup.motion_table_hash);
  out.numbers["limiter_is_frozen"] = {flow_.iteration().limiter_is_frozen() ? 1.0 : 0.0};
  out.numbers["limiter_threshold"] = {flow_.discretization().space().limiter_threshold};
  out.numbers["steady_loads"] = numbers_of(flow_.steady_report().loads);
  return out;
}

CheckpointHead FlowCheckpoint::steady_head(std::string phase) const {
  auto out = head(std::move(phase));
  const auto& [steady, attempt] = flow_.march_state();
  out.numbers["iteration"] = {static_cast<Real>(steady.iteration)};
  out.numbers["attempt"] = {static_cast<Real>(attempt)};
  out.numbers["cfl"] = {steady.cfl};
  out.numbers["residuals"] = {steady.first_residual, steady.previous_residual};
  out.numbers["lowest_residual"] = {steady.lowest_residual, static_cast<Real>(steady.lowest_at)};
  out.numbers["begun"] = {steady.begun_residual, static_cast<Real>(steady.begun_at),
                          static_cast<Real>(steady.rejections)};
  out.numbers["krylov"] = {static_cast<Real>(steady.krylov)};
  out.numbers["load_range"] = numbers_of(std::array{steady.least, steady.most});
  return out;
}

void FlowCheckpoint::restore_march() {
  const auto& numbers = checkpoints_.restart()->numbers;
  const auto range = loads_of(numbers.at("load_range"));
  const auto begun = numbers.contains("begun") ? numbers.at("begun")
                                               : std::vector<Real>{numbers.at("residuals").at(0), 0, 0};
  flow_.go_on_from(
      {{static_cast<int>(numbers.at("iteration").at(0)), numbers.at("cfl").at(0),
        numbers.at("residuals").at(0), numbers.at("residuals").at(1), numbers.at("lowest_residual").at(0),
        static_cast<int>(numbers.at("lowest_residual").at(1)), begun.at(0), static_cast<int>(begun.at(1)),
        static_cast<int>(begun.at(2)), range.at(0), range.at(1),
        numbers.contains("krylov") ? static_cast<KrylovSteps>(numbers.at("krylov").at(0))
                                   : KrylovSteps::not_yet},
       static_cast<std::size_t>(numbers.at("attempt").at(0))});
  restore();
}

void FlowCheckpoint::restore_steady() {
  const CheckpointHead& head = *checkpoints_.restart();
  record_.take_up(head.message);
  flow_.set_steady_loads(loads_of(head.numbers.at("steady_loads")));
}

}  // namespace alphadot
