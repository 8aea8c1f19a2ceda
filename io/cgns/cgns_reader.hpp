// Reads CGNS files. Part of the converter only: the CGNS library brings an HDF5 library of its own.
#pragma once

#include <functional>
#include <string>

#include "io/mesh_of_file.hpp"

namespace alphadot {

/// The mesh in the only zone of the only base of a CGNS file: unstructured, of any shapes, in sections of one
/// type or MIXED; all but tetrahedra and triangles are cut into these. A face belongs to the patch of the
/// boundary condition that lists it, which is named by its family or, without one, by itself; other faces to
/// the patch of their section's name. `tell` gets what a person should know of what was passed over. Throws
/// InputError for damaged files, structured or several zones, and polyhedra (NGON_n, NFACE_n). Not for two
/// threads at once. Source: CGNS Standard Interface Data Structures, sections 7.3 (Elements_t) and 9.3
/// (BC_t).
MeshOfFile read_cgns(const std::string& path, const std::function<void(const std::string&)>& tell);

}  // namespace alphadot
