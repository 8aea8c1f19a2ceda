// Reads a mesh file of any known format.
#pragma once

#include <string>

#include "partition/mesh.hpp"

namespace alphadot {

/// The mesh in the file at `path`: Gmsh 2.2 and 4.1 (.msh, ASCII and binary), SU2 (.su2) or UGRID (.b8.ugrid,
/// .lb8.ugrid, with the names of a .mapbc file of the same stem when there is one). Call it on the root rank
/// only. Peak memory: the file, the mesh and 24 bytes a point. The mesh is not validated: see
/// Mesh::validate(). Throws InputError, with the line for text and the byte for binary, when the file cannot
/// be read, is damaged, or does not hold what its extension promises.
Mesh read_mesh(const std::string& path);

}  // namespace alphadot
