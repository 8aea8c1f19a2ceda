// How residual and loads of one flow change with the Mach number and the ratio of specific heats.
#pragma once

#include <string>
#include <vector>

#include "derivatives/functional.hpp"
#include "march/implicit_iteration.hpp"

namespace alphadot {

/// A number of the free stream.
struct StreamNumber {
  std::string name;              ///< "mach", "gamma"
  Real FreestreamSettings::*at;  ///< where the case has it
};
inline const StreamNumber stream_numbers[] = {{"mach", &FreestreamSettings::mach},
                                              {"gamma", &FreestreamSettings::gamma}};

/// The change of R(W) and of the loads with a number of the free stream at a flow W that is held, incidence
/// and reduced rates too: central differences of whole residuals, exact to about nine digits. With an adjoint
/// psi, dC/dm = by_itself(C) - psi . residual().
class StreamChange {
 public:
  /// About the flow of `iteration`, in the case `settings`. Collective.
  StreamChange(ImplicitIteration& iteration, const FlightCondition& settings, const StreamNumber& number);

  const std::string& name() const { return name_; }
  /// [owned_cells]
  const std::vector<Conserved<Real>>& residual() const { return residual_; }
  /// Change of a coefficient that the flow has no part in.
  Real by_itself(const Functional& functional, const std::vector<std::string>& patch_names) const;

 private:
  struct Side {
    FlightCondition settings;
    std::vector<Load> loads;  ///< of every patch, over all ranks
  };

  std::string name_;
  Real step_;
  Side below_, above_;
  std::vector<Conserved<Real>> residual_;
};

}  // namespace alphadot
