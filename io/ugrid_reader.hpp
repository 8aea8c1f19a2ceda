// Reads UGRID files, the format of AFLR3 and FUN3D.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "io/mesh_of_file.hpp"
#include "io/scanner.hpp"

namespace alphadot {

/// Patch names by surface id.
using SurfaceNames = std::map<std::int32_t, std::string>;

/// How the numbers of a UGRID file stand in it; integers have 32 bits.
struct UgridForm {
  Encoding encoding = Encoding::text;
  bool single_reals = false;     ///< reals have 32 bits, otherwise 64
  bool fortran_records = false;  ///< header and data stand between their lengths, as Fortran writes them

  bool operator==(const UgridForm&) const = default;
};

/// The form that the extension of a file tells: .ugrid is text; before it stand .b8 and .lb8, .b4 and .lb4
/// (32-bit reals), .r8 and .lr8, .r4 and .lr4 (Fortran records), with "l" for little-endian numbers. `name`
/// is in lower case.
std::optional<UgridForm> ugrid_form(std::string_view name);

/// The mesh in a UGRID file. `content` holds the whole file and `file` names it in messages. Elements of any
/// shape are cut into tetrahedra and triangles (see element_cutting.hpp). Patches are the surface ids: by the
/// name in `names`, or "patch_<id>"; ids of one name make one patch. What some programs append after the
/// volume elements is passed over. Throws InputError for damaged files, the other byte order, and files
/// without volume elements.
/// Source: AFLR3 documentation, "UGRID file format" (www.simcenter.msstate.edu).
MeshOfFile read_ugrid(std::string_view content, const std::string& file, const UgridForm& form,
                      const SurfaceNames& names = {});

/// The names in a .mapbc file. FUN3D's begin with the number of surfaces; then comes a line "id condition
/// name" for each. USM3D's begin with comments; then come lines of five numbers, of which the first is the
/// id, and a name, to the end of the file. Names may be of several words. A remark from '!' or '#' on is
/// passed over, but where it stands in the place of the name, it is taken for it. Ids without either are left
/// out. Throws InputError for damaged files.
SurfaceNames read_mapbc(std::string_view content, const std::string& file);

}  // namespace alphadot
