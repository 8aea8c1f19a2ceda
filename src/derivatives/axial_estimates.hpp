// What a case says of the axial force beside what its walls feel.
#pragma once

#include <string>
#include <vector>

#include "derivatives/case.hpp"
#include "space/configuration.hpp"

namespace alphadot {

/// A part of CA that is no result of the flow.
struct AxialEstimate {
  std::string name;    ///< "base" or "friction"
  Real CA = 0;         ///< of the whole configuration
  std::string source;  ///< what it rests on, for people
};

/// Of the base, where jets leave one open, and of friction, where the case has a Reynolds number. Each set of
/// [components] and what is in none, the body, is a plate as long as itself.
std::vector<AxialEstimate> axial_estimates(const Configuration& configuration,
                                           const std::vector<std::string>& patch_names, const Case& settings);

}  // namespace alphadot
