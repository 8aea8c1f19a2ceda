// Reads Gmsh files of versions 2.2 and 4.1, ASCII and binary.
#pragma once

#include <string>
#include <string_view>

#include "partition/mesh.hpp"

namespace alphadot {

/// The tetrahedra and named surface triangles of a Gmsh file. `content` holds the whole file and `file` names
/// it in messages. Patches are the named physical groups of dimension 2; points and lines, physical groups of
/// other dimensions and unknown sections are passed over, points that no element uses are dropped.
/// Orientation is kept as written and is for Mesh::validate() to judge. Throws InputError for other versions,
/// damaged files, elements other than linear tetrahedra and triangles, triangles without a named physical
/// group or with several, and files without tetrahedra. Source: Gmsh reference manual, "MSH file format" and
/// "MSH file format version 2 (Legacy)".
Mesh read_gmsh(std::string_view content, const std::string& file);

}  // namespace alphadot
