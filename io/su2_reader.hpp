// Reads SU2's native mesh files.
#pragma once

#include <string>
#include <string_view>

#include "partition/mesh.hpp"

namespace alphadot {

/// The tetrahedra and markers of a three-dimensional SU2 file. `content` holds the whole file and `file`
/// names it in messages. Patches are the markers. Sections may come in any order; keywords that do not
/// concern a single-zone tetrahedral mesh (FFD boxes, periodic pairs and the like) are passed over with their
/// data. Throws InputError for damaged files, other dimensions, several zones, elements other than tetrahedra
/// and triangles, points numbered otherwise than by their order, and files without tetrahedra. Source: SU2
/// documentation, "Mesh File" (su2code.github.io/docs_v7/Mesh-File).
Mesh read_su2(std::string_view content, const std::string& file);

}  // namespace alphadot
