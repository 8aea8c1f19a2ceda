// Walls without thickness: a surface inside the mesh becomes a wall with two sides.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "partition/mesh.hpp"

namespace alphadot {

/// Opens the mesh along those triangles of the named patches that lie between two cells: the patch then holds
/// each of them twice, once for either side, so that its loads are those of both sides together. Points
/// within such a surface, and where it meets another patch, become as many as there are sides around them;
/// those of its free edges stay one. A triangle whose corners all lie on free edges, as at the corner of a
/// fin, is cut in three about its middle first, with the cells beside it: else its two sides would have the
/// same points and be one face.
///
/// The rest of the patch stays what it is, and a surface that parts the mesh is left alone, for
/// Mesh::validate() to tell. Returns what was done, a sentence a patch. Throws InputError when the mesh does
/// not have a patch, or the patch nothing inside; ids of points must be in range. Memory: 40 bytes a cell.
std::vector<std::string> open_thin_walls(Mesh& mesh, std::span<const std::string> patches);

}  // namespace alphadot
