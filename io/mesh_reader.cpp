#include "io/mesh_reader.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string_view>
#include <system_error>

#include "core/error.hpp"
#include "io/gmsh_reader.hpp"
#include "io/su2_reader.hpp"
#include "io/ugrid_reader.hpp"

namespace alphadot {
namespace {

enum class Format { gmsh, su2, ugrid_big_endian, ugrid_little_endian };

[[noreturn]] void fail_unknown(const std::string& path, const std::string& what) {
  throw InputError(
      path, 0, what,
      "known are Gmsh 2.2 and 4.1 (.msh), SU2 (.su2), UGRID (.b8.ugrid, .lb8.ugrid) and what alphadot "
      "partition makes of them");
}

/// Tells the format by the extension.
Format format_of(const std::string& path) {
  if (path.ends_with(".msh")) return Format::gmsh;
  if (path.ends_with(".su2")) return Format::su2;
  if (path.ends_with(".lb8.ugrid")) return Format::ugrid_little_endian;
  if (path.ends_with(".b8.ugrid")) return Format::ugrid_big_endian;
  if (path.ends_with(".cgns"))
    throw InputError(path, 0, "CGNS files are not read directly",
                     "convert it: alphadot-cgns2su2 " + path + " mesh.su2");
  fail_unknown(path, "the extension tells no known mesh format");
}

/// Makes sure that the file begins the way its extension promises.
void check_beginning(const std::string& path, std::string_view content, Format format) {
  const bool begins_as_gmsh = content.starts_with("$MeshFormat");
  if (format == Format::gmsh && !begins_as_gmsh)
    fail_unknown(path, "the file does not begin with $MeshFormat, so it is no Gmsh file of a known version");
  if (format != Format::gmsh && begins_as_gmsh)
    fail_unknown(path, "the file is a Gmsh file, but has another extension");
  // Text has no bytes below tab; a binary file has some among the first few numbers.
  const std::string_view beginning = content.substr(0, 256);
  const bool binary =
      std::any_of(beginning.begin(), beginning.end(), [](char c) { return c >= 0 && c < '\t'; });
  if (format == Format::su2 && binary) fail_unknown(path, "the file is binary, so it is no SU2 mesh");
}

std::string read_file(const std::string& path) {
  const auto fail = [&](const std::string& why) {
    throw InputError(path, 0, "cannot read the file: " + why, "check [mesh] file");
  };
  std::error_code error;
  if (!std::filesystem::exists(path, error)) fail("there is no such file");
  if (!std::filesystem::is_regular_file(path, error)) fail("it is not a regular file");
  const std::uintmax_t size = std::filesystem::file_size(path, error);
  std::ifstream stream(path, std::ios::binary);
  if (error || !stream) fail("it cannot be opened");
  std::string content(size, '\0');
  stream.read(content.data(), static_cast<std::streamsize>(size));
  if (static_cast<std::uintmax_t>(stream.gcount()) != size) fail("it ends before its size is reached");
  return content;
}

/// The names in the .mapbc file beside wing.b8.ugrid, which is wing.mapbc.
SurfaceNames names_beside(const std::string& path, std::string_view extension) {
  const std::string mapbc = path.substr(0, path.size() - extension.size()) + ".mapbc";
  std::error_code error;
  return std::filesystem::exists(mapbc, error) ? read_mapbc(read_file(mapbc), mapbc) : SurfaceNames{};
}

}  // namespace

Mesh read_mesh(const std::string& path) {
  const Format format = format_of(path);
  const std::string content = read_file(path);
  check_beginning(path, content, format);
  switch (format) {
    case Format::gmsh:
      return read_gmsh(content, path);
    case Format::su2:
      return read_su2(content, path);
    case Format::ugrid_big_endian:
      return read_ugrid(content, path, Encoding::big_endian, names_beside(path, ".b8.ugrid"));
    case Format::ugrid_little_endian:
      return read_ugrid(content, path, Encoding::little_endian, names_beside(path, ".lb8.ugrid"));
  }
  throw std::logic_error("unhandled mesh format");
}

}  // namespace alphadot
