// The adjoints that a run has solved for, kept in its checkpoints.
#pragma once

#include <map>
#include <string>

#include "app/flow_case.hpp"
#include "derivatives/functional.hpp"

namespace alphadot {

class Adjoints {
 public:
  /// Begins with those of the checkpoint that the run goes on from, when they are adjoints of the flow that
  /// `flow` has marched to under the same [derivatives]; else with none. Collective. The flow must outlive
  /// the object.
  explicit Adjoints(FlowCase& flow);

  bool has(const Functional& functional) const { return solved_.contains(functional.name()); }
  const Adjoint& at(const Functional& functional) const { return solved_.at(functional.name()); }
  void add(Adjoint adjoint) { solved_[adjoint.name] = std::move(adjoint); }
  /// Writes a checkpoint with the steady flow and all adjoints. Collective.
  void save();

 private:
  FlowCase& flow_;
  std::map<std::string, Adjoint> solved_;  // by the functional's name
};

}  // namespace alphadot
