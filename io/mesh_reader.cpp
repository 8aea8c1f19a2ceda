#include "io/mesh_reader.hpp"

#include <algorithm>
#include <filesystem>
#include <string_view>
#include <system_error>
#include <vector>

#include "core/error.hpp"
#include "io/files.hpp"
#include "io/foreign_files.hpp"
#include "io/gmsh_reader.hpp"
#include "io/gzip.hpp"
#include "io/su2_reader.hpp"
#include "io/ugrid_reader.hpp"

namespace alphadot {
namespace {

[[noreturn]] void fail_unknown(const std::string& path, const std::string& what) {
  throw InputError(
      path, 0, what,
      "known are Gmsh (.msh), SU2 (.su2), UGRID (.ugrid, .b8.ugrid, .lb8.ugrid ...), each also with "
      ".gz, and what alphadot partition makes of them");
}

[[noreturn]] void fail_with(const Problem& problem) {
  throw InputError(std::vector{problem});
}

/// The name of a file, by which its format is told: without ".gz", in lower case.
std::string plain_name(std::string name) {
  name = in_lower_case(name);
  if (name.ends_with(".gz")) name.resize(name.size() - 3);
  return name;
}

/// Makes sure that the name is one of a mesh.
void check_name(const std::string& path, const std::string& name) {
  if (const auto problem = foreign_name(path, name)) fail_with(*problem);
  if (name.ends_with(".msh") || name.ends_with(".su2") || name.ends_with(".ugrid")) return;
  if (const auto problem = foreign_content(path, beginning_of(path), Expected::text)) fail_with(*problem);
  fail_unknown(path, "the extension tells no known mesh format");
}

/// Makes sure that the file begins the way its extension promises.
void check_beginning(const std::string& path, std::string_view content, const std::string& name) {
  const auto form = ugrid_form(name);
  const bool is_binary_form = form && form->encoding != Encoding::text;
  if (const auto problem = foreign_content(path, content, is_binary_form ? Expected::binary : Expected::text))
    fail_with(*problem);
  const std::string_view beginning = content.substr(0, 256);
  const std::size_t first = beginning.find_first_not_of(" \t\r\n\xef\xbb\xbf");
  const bool begins_as_gmsh = first != std::string_view::npos && beginning[first] == '$';
  if (name.ends_with(".msh") && !begins_as_gmsh)
    fail_unknown(path, "the file does not begin with a section such as $MeshFormat, so it is no Gmsh file");
  if (!name.ends_with(".msh") && begins_as_gmsh && beginning.substr(first).starts_with("$MeshFormat"))
    fail_unknown(path, "the file is a Gmsh file, but has another extension");
  // Text has no bytes below tab; a binary file has some among the first few numbers.
  const bool binary =
      std::any_of(beginning.begin(), beginning.end(), [](char c) { return c >= 0 && c < '\t'; });
  if (name.ends_with(".su2") && binary) fail_unknown(path, "the file is binary, so it is no SU2 mesh");
}

/// Lines of old Macintosh programs end with a carriage return alone.
void mend_line_ends(std::string& content, const std::string& name) {
  const bool is_text = name.ends_with(".msh") || name.ends_with(".su2");
  if (is_text && content.find('\n') == std::string::npos)
    std::replace(content.begin(), content.end(), '\r', '\n');
}

/// The names in the .mapbc file beside wing.b8.ugrid, which is wing.mapbc or wing.b8.mapbc.
SurfaceNames names_beside(const std::string& path) {
  std::filesystem::path stem(path);
  if (plain_name(path).size() < path.size()) stem.replace_extension();
  std::error_code error;
  while (stem.has_extension()) {
    const std::string mapbc = stem.replace_extension(".mapbc");
    if (std::filesystem::exists(mapbc, error)) return read_mapbc(read_file(mapbc, "list of patches"), mapbc);
    stem.replace_extension();
  }
  return {};
}

}  // namespace

MeshOfFile read_mesh(const std::string& path) {
  const std::string name = plain_name(path);
  if (const auto problem = foreign_folder(path)) fail_with(*problem);
  // A pointer to a file has the name of the file itself.
  if (const auto problem = foreign_content(path, beginning_of(path), Expected::binary)) fail_with(*problem);
  check_name(path, name);
  std::string content = read_file(path, "mesh");
  if (is_gzip(content)) content = gunzip(content, path);
  check_beginning(path, content, name);
  mend_line_ends(content, name);
  if (name.ends_with(".msh")) return read_gmsh(content, path);
  if (name.ends_with(".su2")) return read_su2(content, path);
  return read_ugrid(content, path, *ugrid_form(name), names_beside(path));
}

}  // namespace alphadot
