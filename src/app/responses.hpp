// The linear responses that a run of derivatives has solved for, kept in its checkpoints.
#pragma once

#include <map>

#include "analysis/derivatives.hpp"
#include "app/flow_case.hpp"
#include "solver/sensitivity.hpp"

namespace alphadot {

class Responses {
 public:
  /// Begins with those of the checkpoint that the run goes on from, when they are responses of the flow that
  /// `flow` has marched to under the same [derivatives]; else with none. Collective. The flow must outlive
  /// the object.
  explicit Responses(FlowCase& flow);

  bool has(Variable variable) const { return solved_.contains(variable); }
  const Sensitivity& at(Variable variable) const { return solved_.at(variable); }
  void add(Variable variable, Sensitivity response) { solved_[variable] = std::move(response); }
  /// Writes a checkpoint with the steady flow and all responses. Collective.
  void save();

 private:
  FlowCase& flow_;
  std::map<Variable, Sensitivity> solved_;
};

}  // namespace alphadot
