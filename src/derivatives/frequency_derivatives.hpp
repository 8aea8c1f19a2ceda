// Stability derivatives of a case at finite frequency, from linear solves about its steady flow.
#pragma once

#include <compare>
#include <map>
#include <string>
#include <vector>

#include "analysis/frequency_table.hpp"
#include "derivatives/frequency_response.hpp"
#include "derivatives/linear_derivatives.hpp"

namespace alphadot {

/// The responses to oscillating variables that have been solved for. Of their fields the latest of each
/// variable is kept, for those of other frequencies begin from it.
class Oscillations {
 public:
  struct Key {
    Real k;
    Variable variable;
    auto operator<=>(const Key&) const = default;
  };
  bool has(Variable variable, Real k) const { return solved_.contains({k, variable}); }
  /// Without its field.
  const FrequencyResponse& at(Variable variable, Real k) const { return solved_.at({k, variable}); }
  void add(Variable variable, Real k, FrequencyResponse response);

  const std::map<Key, FrequencyResponse>& solved() const { return solved_; }
  /// The latest field of each variable, real part and then imaginary one, to be kept or to be put back.
  std::map<Variable, std::vector<Primitive<Real>>>& latest() { return latest_; }
  /// Puts back a response without its field.
  void put_back(Key key, FrequencyResponse response) { solved_[key] = std::move(response); }

 private:
  std::map<Key, FrequencyResponse> solved_;
  std::map<Variable, std::vector<Primitive<Real>>> latest_;
};

/// Solves for the responses of the steady flow that `flow` has marched to, at the reduced frequencies k =
/// omega length / 2V, ascending, to alpha and q, on a full model beta, p and r too; but for those that
/// `oscillations` has already, which takes the others; the observer is told of each. False when the observer
/// ended it. Collective. Throws DivergedError.
bool solve_oscillations(FlowCase& flow, const std::vector<Real>& frequencies, bool with_gusts,
                        Oscillations& oscillations, const SolveObserver& observer = {});

/// All rows, of the whole and of every wall; adds why some are not converged to `shortfalls`.
std::vector<FrequencyRow> frequency_rows(const FlowCase& flow, const std::vector<Real>& frequencies,
                                         bool with_gusts, const Oscillations& oscillations,
                                         std::vector<std::string>& shortfalls);

}  // namespace alphadot
