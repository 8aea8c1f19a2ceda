// Reads binary UGRID files, the format of AFLR3 and FUN3D.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>

#include "io/scanner.hpp"
#include "partition/mesh.hpp"

namespace alphadot {

/// Patch names by surface id.
using SurfaceNames = std::map<std::int32_t, std::string>;

/// The tetrahedra and surface triangles of a UGRID file with 32-bit integers and 64-bit reals. `content`
/// holds the whole file and `file` names it in messages; `encoding` is big_endian for .b8.ugrid and
/// little_endian for .lb8.ugrid. Patches are the surface ids: by the name in `names`, or "patch_<id>"; ids of
/// one name make one patch. What some programs append after the volume elements is passed over. Throws
/// InputError for damaged files, the other byte order, elements other than tetrahedra and triangles, and
/// files without tetrahedra.
/// Source: AFLR3 documentation, "UGRID file format" (www.simcenter.msstate.edu).
Mesh read_ugrid(std::string_view content, const std::string& file, Encoding encoding,
                const SurfaceNames& names = {});

/// The names in a FUN3D .mapbc file: a line with the number of surfaces, then one line "id condition name"
/// each. The condition is passed over; ids without a name are left out. Throws InputError for damaged files.
SurfaceNames read_mapbc(std::string_view content, const std::string& file);

}  // namespace alphadot
