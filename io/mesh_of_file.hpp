// A mesh together with what its file tells beside it.
#pragma once

#include <string>
#include <vector>

#include "partition/mesh.hpp"

namespace alphadot {

/// A named part of the volume: the cells from `first_cell` up to the next region.
struct NamedVolume {
  std::string name;
  GlobalIndex first_cell;
};

struct MeshOfFile : Mesh {
  std::vector<NamedVolume> regions;  ///< by first cell, if the file tells; one name may come several times
  std::vector<std::string> notes;    ///< what a person should know of how it was read
};

}  // namespace alphadot
