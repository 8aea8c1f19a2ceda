// What a mesh is as a configuration, for people and for result.json.
#pragma once

#include <string>

#include "derivatives/setup.hpp"
#include "io/result.hpp"

namespace alphadot {

/// Half a dozen lines on body, walls, far field, symmetry and cells.
std::string configuration_text(const Setup& setup);

/// The same as named numbers, with the warnings.
ConfigurationResult configuration_result(const Setup& setup);

}  // namespace alphadot
