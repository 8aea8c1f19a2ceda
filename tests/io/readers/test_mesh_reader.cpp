// read_mesh: the choice of the format, and files that Gmsh and meshio wrote (data/make_samples.py).
#include "io/mesh_reader.hpp"

#include <zlib.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "io/gmsh_reader.hpp"
#include "io/readers/small_meshes.hpp"
#include "io/temporary_folder.hpp"
#include "support/box_mesh.hpp"

namespace alphadot {
namespace {

using test::expect_parts;

std::string sample(const std::string& name) {
  return std::string(ALPHADOT_TEST_DATA) + "/data/" + name;
}
std::string error_in(const std::string& path) {
  return test::error_of([&] { read_mesh(path); });
}

class MeshReader : public testing::Test {
 protected:
  /// The path of a new file with this content.
  std::string write(const std::string& name, const std::string& content) const {
    std::ofstream(folder_ / name, std::ios::binary) << content;
    return folder_ / name;
  }

  TemporaryFolder folder_;
};

TEST_F(MeshReader, ReadsEveryFormat) {
  test::expect_two_cells(read_mesh(write("a.msh", test::gmsh_22(Encoding::text))), "wall", "far field");
  test::expect_two_cells(read_mesh(write("b.msh", test::gmsh_41(native_encoding))), "wall", "far field");
  test::expect_two_cells(read_mesh(write("a.su2", test::su2())), "wall", "far_field");
  test::expect_two_cells(read_mesh(write("a.b8.ugrid", test::ugrid(Encoding::big_endian))), "patch_1",
                         "patch_2");
  test::expect_two_cells(read_mesh(write("a.lb8.ugrid", test::ugrid(Encoding::little_endian))), "patch_1",
                         "patch_2");
  write("a.mapbc", "2\n1 4000 body\n2 5000 outer\n");
  test::expect_two_cells(read_mesh(folder_ / "a.b8.ugrid"), "body", "outer");
  test::expect_two_cells(read_mesh(folder_ / "a.lb8.ugrid"), "body", "outer");
}

TEST_F(MeshReader, RefusesWhatIsNoKnownMesh) {
  const char* const known =
      "known are Gmsh (.msh), SU2 (.su2), UGRID (.ugrid, .b8.ugrid, .lb8.ugrid ...), each also with .gz, and "
      "what alphadot partition makes of them";
  const std::string gmsh = test::gmsh_22(Encoding::text);
  expect_parts(error_in(write("a.grid", "1 2 3")), {"a.grid: ", "extension", known});
  expect_parts(error_in(write("a.msh", "")), {"does not begin with a section", known});
  expect_parts(error_in(write("b.msh", "mesh of two cells")), {"does not begin with a section", known});
  expect_parts(error_in(write("a.ugrid", test::ugrid(Encoding::big_endian))),
               {"big-endian", "extension .b8.ugrid"});
  expect_parts(error_in(write("a.su2", gmsh)), {"is a Gmsh file", known});
  expect_parts(error_in(write("a.b8.ugrid", gmsh)), {"is a Gmsh file", known});
  expect_parts(error_in(write("b.su2", test::ugrid(Encoding::big_endian))), {"is binary", known});
}

TEST_F(MeshReader, NamesWhatOtherProgramsWrite) {
  const std::string pointer = "version https://git-lfs.github.com/spec/v1\noid sha256:4d7a\nsize 12345\n";
  for (const char* name : {"a.msh", "a.su2", "a.b8.ugrid", "a.ugrid", "a.cgns", "a.msh.gz", "a"})
    expect_parts(error_in(write(name, pointer)), {"Git LFS pointer", "git lfs pull"});
  expect_parts(error_in(write("stl.msh", "solid fin\n facet normal 0 0 1\n")), {"STL", "mesh the volume"});
  expect_parts(error_in(write("ply.su2", "ply\nformat ascii 1.0\n")), {"PLY"});
  expect_parts(error_in(write("nastran.msh", "$ Created by Gmsh\nGRID    1\n")),
               {"Nastran", "lose their names"});
  expect_parts(error_in(write("b.msh", "(0 \"GAMBIT to Fluent File\")\n(2 3)\n")), {"Fluent", "CGNS"});
  expect_parts(error_in(write("blank.msh", "\n (0 \"GAMBIT to Fluent File\")\n(2 3)\n")), {"Fluent", "CGNS"});
  for (const char* page : {"<!DOCTYPE html>\n<html>", "\r\n<!doctype HTML>", "\xef\xbb\xbf<HTML>"})
    expect_parts(error_in(write("c.msh", page)), {"web page"});
  expect_parts(error_in(write("points", "/*------- C++ -------*\\\n")), {"OpenFOAM"});
  expect_parts(error_in(write("wide.su2", std::string("\xff\xfeN\0D\0", 6))), {"UTF-16"});
  expect_parts(error_in(write("wing.lb8l.ugrid", "")), {"integers of 64 bits"});
  expect_parts(error_in(write("wing.tar", "")), {"archive", "unpack it"});
  expect_parts(error_in(write("d.msh", "PK\x03\x04")), {"zip archive"});
  expect_parts(error_in(write("wing.unv", "")), {"I-deas", "gmsh FILE -save"});
  expect_parts(error_in(write("wing.stl", "")), {"a surface without a volume"});
  expect_parts(error_in(write("wing.geo", "")), {"description of a geometry", "gmsh -3"});
  expect_parts(error_in(write("wing.cgns", "")), {"alphadot-cgns2su2"});
  std::filesystem::create_directories(folder_ / "case/constant/polyMesh");
  std::ofstream(folder_ / "case/constant/polyMesh/owner") << "FoamFile\n";
  for (const char* name : {"case", "case/constant", "case/constant/polyMesh"})
    expect_parts(error_in(folder_ / name), {"OpenFOAM", "polyhedra cannot be used"});
}

std::string compressed(const std::string& content) {
  std::string out(2 * content.size() + 100, '\0');
  z_stream stream{};
  if (deflateInit2(&stream, 9, Z_DEFLATED, 16 + MAX_WBITS, 8, Z_DEFAULT_STRATEGY) != Z_OK) ADD_FAILURE();
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(content.data()));
  stream.avail_in = static_cast<uInt>(content.size());
  stream.next_out = reinterpret_cast<Bytef*>(out.data());
  stream.avail_out = static_cast<uInt>(out.size());
  if (deflate(&stream, Z_FINISH) != Z_STREAM_END) ADD_FAILURE();
  out.resize(stream.total_out);
  deflateEnd(&stream);
  return out;
}

TEST_F(MeshReader, ReadsCompressedFilesAndCapitals) {
  const std::string gmsh = test::gmsh_22(Encoding::text);
  for (const auto& [name, content] :
       {std::pair{"a.msh.gz", compressed(gmsh)}, std::pair{"a.msh", compressed(gmsh)},
        std::pair{"A.MSH", gmsh},
        std::pair{"b.Msh.GZ", compressed(gmsh.substr(0, 200)) + compressed(gmsh.substr(200))}})
    test::expect_two_cells(read_mesh(write(name, content)), "wall", "far field");
  test::expect_two_cells(read_mesh(write("a.SU2", test::su2())), "wall", "far_field");
  write("c.mapbc", "2\n1 4000 the body\n2 5000 outer\n");
  for (const auto& [name, content] :
       {std::pair{"c.B8.UGRID", test::ugrid(Encoding::big_endian)},
        std::pair{"c.lb8.ugrid.gz", compressed(test::ugrid(Encoding::little_endian))},
        std::pair{"c.ugrid", test::ugrid(Encoding::text)}})
    test::expect_two_cells(read_mesh(write(name, content)), "the body", "outer");

  const std::string whole = compressed(gmsh);
  for (std::size_t size = 3; size < whole.size(); size += 7)
    expect_parts(error_in(write("cut.msh.gz", whole.substr(0, size))),
                 {"cannot be decompressed", "ends too early"});
  std::string damaged = whole;
  damaged[whole.size() / 2] ^= 0x10;
  expect_parts(error_in(write("cut.msh.gz", damaged)), {"cannot be decompressed"});
  expect_parts(error_in(write("bomb.msh.gz", compressed(std::string(8 << 20, ' ')))), {"100 times its size"});
}

TEST_F(MeshReader, ABinaryMeshMayBeginWithAnyNumber) {
  // 40 points of 256 are a bracket in the first byte, as in files of Fluent.
  constexpr int points = 40, layers = points / 4 - 1;
  const Mesh box = testing_support::box_mesh({.cells = {1, 1, layers}});
  ASSERT_EQ(std::ssize(box.points), points);
  test::Writer writer(Encoding::little_endian);
  writer.ints({points, 12 + 8 * (layers - 1), 0, 6 * layers, 0, 0, 0});
  for (const Vec3& at : box.points) writer.reals({at.x, at.y, at.z});
  const auto put = [&](const auto& elements) {
    for (const auto& element : elements)
      for (const GlobalIndex point : element) writer.put(static_cast<std::int32_t>(point + 1));
  };
  const auto triangles = box.boundary_triangles();
  ASSERT_EQ(triangles.size(), 12u + 8 * (layers - 1));
  put(triangles);
  for (std::size_t i = 0; i < triangles.size(); ++i) writer.ints({1});
  put(box.cells);
  ASSERT_EQ(writer.content()[0], '(');
  const MeshOfFile mesh = read_mesh(write("a.lb8.ugrid", writer.content()));
  EXPECT_NO_THROW(mesh.validate());
  EXPECT_EQ(mesh.cells, box.cells);
}

TEST_F(MeshReader, LinesThatEndWithACarriageReturn) {
  for (const std::string& text : {test::gmsh_22(Encoding::text), test::gmsh_41(Encoding::text)}) {
    std::string old = text;
    std::ranges::replace(old, '\n', '\r');
    test::expect_two_cells(read_mesh(write("a.msh", old)), "wall", "far field");
  }
  std::string old = test::su2();
  std::ranges::replace(old, '\n', '\r');
  test::expect_two_cells(read_mesh(write("a.su2", old)), "wall", "far_field");
}

TEST_F(MeshReader, NamesBecomeUtf8) {
  const auto named = [&](const std::string& name) {
    return read_mesh(write("a.su2", test::with(test::su2(), "= wall", "= " + name))).patches[0].name;
  };
  EXPECT_EQ(named("Fl\xfcgel"), "Fl\xc3\xbcgel");      // Latin-1
  EXPECT_EQ(named("Fl\xc3\xbcgel"), "Fl\xc3\xbcgel");  // UTF-8
  EXPECT_EQ(named("\xe7\xbf\xbc"), "\xe7\xbf\xbc");    // the same, of three bytes
  EXPECT_EQ(named("\xe7\xbf"), "\xc3\xa7\xc2\xbf");    // cut short
}

TEST_F(MeshReader, TellsWhyAFileCannotBeRead) {
  expect_parts(error_in(folder_ / "none.msh"), {"none.msh: no such mesh"});
  std::filesystem::create_directory(folder_ / "folder.msh");
  expect_parts(error_in(folder_ / "folder.msh"), {"folder.msh: the mesh is not a regular file"});
}

/// Expects the unit cube that other programs wrote: 24 cells, 4 triangles on x = 0 and 20 elsewhere.
void expect_cube(const std::string& name, const std::string& inlet, const std::string& wall) {
  SCOPED_TRACE(name);
  const MeshOfFile mesh = read_mesh(sample(name));
  EXPECT_NO_THROW(mesh.validate());
  EXPECT_EQ(mesh.points.size(), 14u);
  ASSERT_EQ(mesh.cells.size(), 24u);
  const auto point = [&](GlobalIndex id) { return mesh.points[static_cast<std::size_t>(id)]; };
  Real volume = 0;
  for (const auto& [a, b, c, d] : mesh.cells)
    volume += dot(cross(point(b) - point(a), point(c) - point(a)), point(d) - point(a)) / 6;
  EXPECT_NEAR(volume, 1, 1e-14);
  ASSERT_EQ(mesh.patches.size(), 2u);
  EXPECT_EQ(mesh.patches[0].name, inlet);
  EXPECT_EQ(mesh.patches[1].name, wall);
  EXPECT_EQ(mesh.patches[1].triangles.size(), 20u);
  ASSERT_EQ(mesh.patches[0].triangles.size(), 4u);
  for (const auto& triangle : mesh.patches[0].triangles)
    for (const GlobalIndex id : triangle) EXPECT_EQ(point(id).x, 0);
}

TEST(MeshSamples, CubesOfOtherPrograms) {
  for (const char* name :
       {"cube_22_ascii.msh", "cube_22_binary.msh", "cube_41_ascii.msh", "cube_41_binary.msh",
        "parametric_ascii.msh", "parametric_binary.msh", "all_saved.msh", "meshio_22.msh"})
    expect_cube(name, "inlet side", "wall");
  expect_cube("cube.su2", "inlet_side", "wall");
  expect_cube("cube.b8.ugrid", "patch_1", "patch_2");
  expect_cube("cube.lb8.ugrid", "patch_1", "patch_2");
}

TEST(MeshSamples, WhatOnlyAPartOfIsUsed) {
  for (const char* name : {"partitioned.msh", "partitioned_ghosts_41.msh", "partitioned_ghosts_40.msh",
                           "partitioned_ghosts_22.msh", "cube_40_ascii.msh", "second_order.msh"})
    expect_cube(name, "inlet side", "wall");
  expect_cube("cube_1.msh", "group_1", "group_2");
  const MeshOfFile curved = read_mesh(sample("second_order.msh"));
  ASSERT_EQ(curved.notes.size(), 1u);
  expect_parts(curved.notes[0], {"24 volume elements of higher order", "curvature", "lost"});
}

TEST(MeshSamples, OneFileOfAMeshThatIsSplitIntoSeveral) {
  std::ifstream file(sample("partitioned.msh"));
  std::string part{std::istreambuf_iterator<char>(file), {}};
  const std::string count = "$PartitionedEntities\n2\n";
  part.replace(part.find(count), count.size(), "$PartitionedEntities\n3\n");
  expect_parts(test::error_of([&] { read_gmsh(part, "part.msh"); }), {"2 of 3 partitions", "in one file"});
}

TEST(MeshSamples, HexahedronAndSurfacesWithoutGroups) {
  const MeshOfFile hexahedron = read_mesh(sample("hexahedron.msh"));
  EXPECT_NO_THROW(hexahedron.validate());
  EXPECT_EQ(hexahedron.points.size(), 8u);
  EXPECT_EQ(hexahedron.cells.size(), 6u);
  ASSERT_EQ(hexahedron.patches.size(), 2u);
  EXPECT_EQ(hexahedron.patches[0].triangles.size(), 2u);
  EXPECT_EQ(hexahedron.patches[1].triangles.size(), 10u);
  ASSERT_EQ(hexahedron.notes.size(), 2u);
  expect_parts(hexahedron.notes[0],
               {"1 hexahedra cut into 6 tetrahedra", "1 at least and 1 in the mean before"});
  expect_parts(hexahedron.notes[1], {"6 boundary quadrilaterals cut into 12 triangles"});

  const MeshOfFile unnamed = read_mesh(sample("unnamed.msh"));
  EXPECT_NO_THROW(unnamed.validate());
  ASSERT_EQ(unnamed.patches.size(), 6u);
  for (int i = 0; i < 6; ++i)
    EXPECT_EQ(unnamed.patches[static_cast<std::size_t>(i)].name, "surface_" + std::to_string(i + 1));
  expect_parts(error_in(sample("no_volume.msh")),
               {"no volume elements", "surface of a body", "Physical Volume"});
  expect_parts(error_in(sample("plane.msh")), {"the mesh is two-dimensional", "extrude"});
}

}  // namespace
}  // namespace alphadot
