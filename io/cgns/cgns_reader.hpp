// Reads CGNS files. Part of the converter only: the CGNS library brings an HDF5 library of its own.
#pragma once

#include <functional>
#include <string>

#include "partition/mesh.hpp"

namespace alphadot {

/// The mesh in the only zone of the only base of a CGNS file: unstructured, TETRA_4 in the volume, TRI_3 on
/// the boundary, in sections of these types or MIXED. A triangle belongs to the patch of the boundary
/// condition that lists it, which is named by its family or, without one, by itself; other triangles to the
/// patch of their section's name. `tell` gets what a person should know of what was passed over. Throws
/// InputError for damaged files, structured or several zones, and other elements. Not for two threads at
/// once. Source: CGNS Standard Interface Data Structures, sections 7.3 (Elements_t) and 9.3 (BC_t).
Mesh read_cgns(const std::string& path, const std::function<void(const std::string&)>& tell);

}  // namespace alphadot
