// Derivatives out of a file of a run.
#pragma once

#include <string>
#include <vector>

#include "analysis/coefficients.hpp"
#include "analysis/derivatives.hpp"
#include "core/flight.hpp"
#include "io/provenance.hpp"

namespace alphadot {

/// What a run has found, about the moment centre of its reference.
struct DerivedFile {
  std::string file;
  std::string status;   ///< "converged", ...; empty: not known
  std::string message;  ///< what was not reached; may be empty
  ReferenceSettings reference;
  Origin origin;
  std::string method;
  EstimatedDerivatives estimated;
  std::vector<Coefficients> loads;  ///< of the steady flow of a result, of every step of a history
};

/// Reads a result.json (by its extension) of the verbs run and derivatives, or the history.h5 of a motion.
/// Not collective: for one rank. Throws InputError with the file when it is cut, or has no derivatives.
DerivedFile read_derivatives(const std::string& file);

}  // namespace alphadot
