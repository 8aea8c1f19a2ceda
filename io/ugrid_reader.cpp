#include "io/ugrid_reader.hpp"

#include <array>
#include <utility>

#include "io/mesh_builder.hpp"

namespace alphadot {
namespace {

constexpr const char* damaged = "the file is damaged or was not written completely: write it again";

/// The first seven integers of the file.
struct Header {
  GlobalIndex points = 0, triangles = 0, quadrilaterals = 0, tetrahedra = 0, pyramids = 0, prisms = 0,
              hexahedra = 0;

  /// Whether `size` bytes can hold what the header announces, itself included.
  bool fits(std::size_t size) const {
    for (const GlobalIndex count :
         {points, triangles, quadrilaterals, tetrahedra, pyramids, prisms, hexahedra})
      if (count < 0) return false;
    // Three reals a point; the nodes of every element; an id for every surface element.
    const GlobalIndex bytes = 28 + 24 * points + (12 + 4) * triangles + (16 + 4) * quadrilaterals +
                              16 * tetrahedra + 20 * pyramids + 24 * prisms + 32 * hexahedra;
    return static_cast<std::uint64_t>(bytes) <= size;
  }
};

Header read_header(Scanner& in) {
  const char* const meaning = "one of the seven counts of the header";
  Header header;
  for (GlobalIndex* count : {&header.points, &header.triangles, &header.quadrilaterals, &header.tetrahedra,
                             &header.pyramids, &header.prisms, &header.hexahedra})
    *count = in.read_int(meaning);
  return header;
}

void check_size(const Scanner& in, const Header& header, std::string_view content) {
  if (header.fits(content.size())) return;
  const bool big_endian = in.encoding() == Encoding::big_endian;
  Scanner other(content, in.file());
  other.set_encoding(big_endian ? Encoding::little_endian : Encoding::big_endian);
  if (read_header(other).fits(content.size()))
    in.fail_at(0, std::string("the numbers are in ") + (big_endian ? "little" : "big") + "-endian order",
               std::string("give the file the extension ") + (big_endian ? ".lb8.ugrid" : ".b8.ugrid"));
  in.fail_at(0, "the header announces more than the " + std::to_string(content.size()) + " bytes of the file",
             damaged);
}

/// The point ids of one element. In the file they start from 1.
template <std::size_t n>
std::array<GlobalIndex, n> read_points(Scanner& in, GlobalIndex point_count) {
  std::array<GlobalIndex, n> points;
  for (GlobalIndex& point : points) {
    const GlobalIndex id = in.read_int("a point id");
    if (id < 1 || id > point_count)
      in.fail("an element uses point " + std::to_string(id) + " of " + std::to_string(point_count), damaged);
    point = id - 1;
  }
  return points;
}

/// Reads the triangles, whose surface ids stand after all of them, and passes over the ids.
void read_triangles(Scanner& in, const Header& header, const SurfaceNames& names, MeshBuilder& mesh) {
  Scanner ids = in;
  ids.skip(12 * static_cast<std::size_t>(header.triangles));
  Patch* patch = nullptr;
  std::int32_t id_of_patch = 0;
  for (GlobalIndex i = 0; i < header.triangles; ++i) {
    const std::int32_t id = ids.read_int("a surface id");
    if (patch == nullptr || id != id_of_patch) {
      const auto name = names.find(id);
      patch = &mesh.patch(name != names.end() ? name->second : "patch_" + std::to_string(id), ids);
      id_of_patch = id;
    }
    append(patch->triangles, read_points<3>(in, header.points), ids);
  }
  in = ids;
}

}  // namespace

Mesh read_ugrid(std::string_view content, const std::string& file, Encoding encoding,
                const SurfaceNames& names) {
  Scanner in(content, file);
  in.set_encoding(encoding);
  const Header header = read_header(in);
  check_size(in, header, content);

  MeshBuilder mesh(file);
  const std::pair<const char*, GlobalIndex> others[] = {{"quadrilaterals", header.quadrilaterals},
                                                        {"pyramids", header.pyramids},
                                                        {"prisms", header.prisms},
                                                        {"hexahedra", header.hexahedra}};
  for (const auto& [plural, count] : others)
    if (count > 0) mesh.refuse(plural, count);
  mesh.check_refused(in);

  mesh.points().reserve(static_cast<std::size_t>(header.points));
  for (GlobalIndex i = 0; i < header.points; ++i) mesh.points().push_back(read_coordinates(in));
  read_triangles(in, header, names, mesh);
  mesh.cells().reserve(static_cast<std::size_t>(header.tetrahedra));
  for (GlobalIndex i = 0; i < header.tetrahedra; ++i)
    mesh.cells().push_back(read_points<4>(in, header.points));
  return std::move(mesh).finish("write its volume elements as tetrahedra");
}

SurfaceNames read_mapbc(std::string_view content, const std::string& file) {
  Scanner in(content, file);
  const GlobalIndex count = in.read_int_count("the number of surfaces", {.ints = 2});
  in.read_line();
  SurfaceNames names;
  for (GlobalIndex i = 0; i < count; ++i) {
    const std::int32_t id = in.read_int("a surface id");
    in.read_int("a boundary condition");
    if (!in.at_end_of_line()) names[id] = in.read_word();
    in.read_line();
  }
  return names;
}

}  // namespace alphadot
