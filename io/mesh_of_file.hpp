// A mesh together with what its file tells beside it.
#pragma once

#include <string>
#include <vector>

#include "partition/mesh.hpp"

namespace alphadot {

struct MeshOfFile : Mesh {
  std::vector<std::string> notes;  ///< what a person should know of how it was read
};

}  // namespace alphadot
