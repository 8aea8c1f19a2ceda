// Writes SU2 mesh files.
#pragma once

#include <string>

#include "partition/mesh.hpp"

namespace alphadot {

/// Writes a mesh as a native SU2 file, its patches as markers; read_su2 gives the same mesh, bit for bit,
/// when every point is used. What SU2 cannot have in the name of a marker becomes an underscore. The file
/// takes its name only when it is whole. Throws InputError when it cannot be written, or when two names
/// become one.
void write_su2(const std::string& path, const Mesh& mesh);

}  // namespace alphadot
