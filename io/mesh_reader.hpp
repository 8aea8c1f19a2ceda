// Reads a mesh file of any known format.
#pragma once

#include <string>

#include "io/mesh_of_file.hpp"

namespace alphadot {

/// The mesh in the file at `path`: Gmsh (.msh), SU2 (.su2) or UGRID (.ugrid and its binary forms, with the
/// names of a .mapbc file of the same stem when there is one), each perhaps compressed by gzip; capitals in
/// the extension do not count. Its notes tell what was done to it. Call it on the root rank only. Peak
/// memory: the file, the mesh and 24 bytes a point. The mesh is not validated: see Mesh::validate(). Throws
/// InputError, with the line for text and the byte for binary, when the file cannot be read, is damaged, or
/// does not hold what its extension promises; files that other programs know are named.
MeshOfFile read_mesh(const std::string& path);

}  // namespace alphadot
