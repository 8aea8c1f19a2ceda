#include "io/cgns/su2_writer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <iterator>
#include <set>
#include <vector>

#include "core/error.hpp"
#include "io/files.hpp"

namespace alphadot {
namespace {

constexpr int triangle = 5, tetrahedron = 10;  // as in VTK

std::vector<std::string> marker_names(const Mesh& mesh) {
  std::vector<std::string> out;
  std::set<std::string> taken;
  for (const auto& patch : mesh.patches) {
    std::string name = patch.name;
    std::ranges::replace_if(
        name, [](unsigned char c) { return std::isgraph(c) == 0 || c == '%' || c == '='; }, '_');
    if (!taken.insert(name).second)
      throw InputError(mesh.file, 0, fmt::format("two patches would have the name {}", name),
                       "give them names without blanks that differ");
    out.push_back(std::move(name));
  }
  return out;
}

void write_elements(std::ostream& out, int type, const auto& elements) {
  std::ostreambuf_iterator<char> at(out);
  for (std::size_t i = 0; i < elements.size(); ++i) {
    fmt::format_to(at, "{}", type);
    for (const auto point : elements[i]) fmt::format_to(at, " {}", point);
    fmt::format_to(at, " {}\n", i);
  }
}

void write_mesh(std::ostream& out, const Mesh& mesh, const std::vector<std::string>& names) {
  std::ostreambuf_iterator<char> at(out);
  fmt::format_to(at, "NDIME= 3\nNELEM= {}\n", mesh.cells.size());
  write_elements(out, tetrahedron, mesh.cells);
  fmt::format_to(at, "NPOIN= {}\n", mesh.points.size());
  // The shortest decimals that give the same bits back.
  for (std::size_t i = 0; i < mesh.points.size(); ++i)
    fmt::format_to(at, "{} {} {} {}\n", mesh.points[i].x, mesh.points[i].y, mesh.points[i].z, i);
  fmt::format_to(at, "NMARK= {}\n", mesh.patches.size());
  for (std::size_t i = 0; i < mesh.patches.size(); ++i) {
    fmt::format_to(at, "MARKER_TAG= {}\nMARKER_ELEMS= {}\n", names[i], mesh.patches[i].triangles.size());
    write_elements(out, triangle, mesh.patches[i].triangles);
  }
}

}  // namespace

void write_su2(const std::string& path, const Mesh& mesh) {
  const auto names = marker_names(mesh);
  replace_file(path, [&](const std::string& temporary) {
    errno = 0;
    std::ofstream out(temporary, std::ios::binary);
    write_mesh(out, mesh, names);
    out.close();
    if (!out)
      throw InputError(path, 0, std::string("cannot be written: ") + std::strerror(errno),
                       "check free space, quota and permissions");
  });
}

}  // namespace alphadot
