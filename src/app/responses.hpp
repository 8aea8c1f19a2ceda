// The linear responses that a run of derivatives has solved for, kept in its checkpoints.
#pragma once

#include <compare>
#include <map>

#include "analysis/derivatives.hpp"
#include "app/flow_case.hpp"
#include "derivatives/sensitivity.hpp"

namespace alphadot {

/// What was solved for, and whether the limiter's factors were held meanwhile.
struct ResponseKey {
  Variable variable;
  bool limiter_held = false;
  auto operator<=>(const ResponseKey&) const = default;
};

/// Whether a checkpoint holds linear solutions about the flow that `flow` has marched to, under the same
/// [derivatives].
bool is_of_this_flow(const CheckpointHead& head, const FlowCase& flow);

class Responses {
 public:
  /// Begins with those of the checkpoint that the run goes on from, when they are responses of the flow that
  /// `flow` has marched to under the same [derivatives]; else with none. Collective. The flow must outlive
  /// the object.
  explicit Responses(FlowCase& flow);

  bool has(ResponseKey key) const { return solved_.contains(key); }
  const Sensitivity& at(ResponseKey key) const { return solved_.at(key); }
  void add(ResponseKey key, Sensitivity response) { solved_[key] = std::move(response); }
  /// Writes a checkpoint with the steady flow and all responses. Collective.
  void save();

 private:
  FlowCase& flow_;
  std::map<ResponseKey, Sensitivity> solved_;
};

}  // namespace alphadot
