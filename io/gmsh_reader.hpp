// Reads Gmsh files of formats 1, 2 to 2.2, 4.0 and 4.1, ASCII and binary.
#pragma once

#include <string>
#include <string_view>

#include "io/mesh_of_file.hpp"

namespace alphadot {

/// The mesh in a Gmsh file. `content` holds the whole file and `file` names it in messages. Volume elements
/// of any shape are cut into tetrahedra (see element_cutting.hpp); of those of higher order the corners are
/// used. Patches are the physical groups of dimension 2, by name or as "group_<tag>"; surfaces in no group
/// are "surface_<tag>"; those between the partitions of a file that Gmsh has cut are passed over, and so are
/// points, lines and unknown sections; points that no element uses are dropped. Throws InputError for other
/// versions, damaged files, unknown elements, surfaces in several named groups, and files without a volume.
/// Source: Gmsh reference manual, "MSH file format" and its legacy versions.
MeshOfFile read_gmsh(std::string_view content, const std::string& file);

}  // namespace alphadot
