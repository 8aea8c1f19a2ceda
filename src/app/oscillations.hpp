// The responses to oscillating variables that a run has solved for, kept in its checkpoints.
#pragma once

#include <compare>
#include <map>
#include <vector>

#include "analysis/derivatives.hpp"
#include "app/flow_case.hpp"
#include "derivatives/frequency_response.hpp"

namespace alphadot {

class Oscillations {
 public:
  /// Begins with those of the checkpoint that the run goes on from, when they are responses of the flow that
  /// `flow` has marched to under the same [derivatives]; else with none. Collective. The flow must outlive
  /// the object.
  explicit Oscillations(FlowCase& flow);

  bool has(Variable variable, Real k) const { return solved_.contains({k, variable}); }
  /// Without its field.
  const FrequencyResponse& at(Variable variable, Real k) const { return solved_.at({k, variable}); }
  /// What the next frequency's solution is near to: the latest field, its imaginary part grown with k. Empty
  /// before the first.
  std::vector<Primitive<Real>> guess(Variable variable, Real k) const;
  void add(Variable variable, Real k, FrequencyResponse response);
  /// Writes a checkpoint with the steady flow, the loads of all responses and the latest field of each
  /// variable. Collective.
  void save();

 private:
  struct Latest {
    Real k = 0;
    std::vector<Primitive<Real>> real, imaginary;
  };
  struct Key {
    Real k;
    Variable variable;
    auto operator<=>(const Key&) const = default;
  };
  FlowCase& flow_;
  std::map<Key, FrequencyResponse> solved_;
  std::map<Variable, Latest> latest_;
};

}  // namespace alphadot
