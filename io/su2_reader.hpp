// Reads SU2's native mesh files.
#pragma once

#include <string>
#include <string_view>

#include "io/mesh_of_file.hpp"

namespace alphadot {

/// The mesh in a three-dimensional SU2 file. `content` holds the whole file and `file` names it in messages.
/// Elements of any shape are cut into tetrahedra and triangles (see element_cutting.hpp). Patches are the
/// markers, whose names may hold blanks; SEND_RECEIVE is none. Sections may come in any order; keywords that
/// do not concern a single-zone mesh (FFD boxes, periodic pairs and the like) are passed over with their
/// data. Throws InputError for damaged files, other dimensions, several zones, elements of another dimension
/// than their section, points numbered otherwise than by their order, and files without volume elements.
/// Source: SU2 documentation, "Mesh File" (su2code.github.io/docs_v7/Mesh-File).
MeshOfFile read_su2(std::string_view content, const std::string& file);

}  // namespace alphadot
