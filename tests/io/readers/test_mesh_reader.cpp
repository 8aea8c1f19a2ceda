// read_mesh: the choice of the format, and files that Gmsh and meshio wrote (data/make_samples.py).
#include "io/mesh_reader.hpp"

#include <filesystem>
#include <fstream>

#include "io/readers/small_meshes.hpp"
#include "io/temporary_folder.hpp"

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
      "known are Gmsh 2.2 and 4.1 (.msh), SU2 (.su2), UGRID (.b8.ugrid, .lb8.ugrid) and what alphadot "
      "partition makes of "
      "them";
  const std::string gmsh = test::gmsh_22(Encoding::text);
  expect_parts(error_in(write("a.vtk", "# vtk")), {"a.vtk: ", "extension", known});
  expect_parts(error_in(write("a.ugrid", "1 2 3")), {"extension", known});
  expect_parts(error_in(write("a.msh", "")), {"does not begin with $MeshFormat", known});
  expect_parts(error_in(write("b.msh", "(0 \"Fluent\")")), {"does not begin with $MeshFormat", known});
  expect_parts(error_in(write("a.su2", gmsh)), {"is a Gmsh file", known});
  expect_parts(error_in(write("a.b8.ugrid", gmsh)), {"is a Gmsh file", known});
  expect_parts(error_in(write("b.su2", test::ugrid(Encoding::big_endian))), {"is binary", known});
}

TEST_F(MeshReader, TellsWhyAFileCannotBeRead) {
  expect_parts(error_in(folder_ / "none.msh"), {"none.msh: cannot read the file: there is no such file"});
  std::filesystem::create_directory(folder_ / "folder.msh");
  expect_parts(error_in(folder_ / "folder.msh"),
               {"folder.msh: cannot read the file: it is not a regular file"});
}

/// Expects the unit cube that other programs wrote: 24 cells, 4 triangles on x = 0 and 20 elsewhere.
void expect_cube(const std::string& name, const std::string& inlet, const std::string& wall) {
  SCOPED_TRACE(name);
  const Mesh mesh = read_mesh(sample(name));
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

TEST(MeshSamples, WhatGmshWritesButTheSolverCannotTake) {
  expect_parts(error_in(sample("hexahedron.msh")), {"1 hexahedra, 6 quadrangles"});
  expect_parts(error_in(sample("second_order.msh")),
               {"24 second-order tetrahedra, 24 second-order triangles"});
  expect_parts(error_in(sample("unnamed.msh")), {"surface 1 belong to no named physical group"});
  expect_parts(error_in(sample("partitioned.msh")), {"save the mesh without partitions"});
  expect_parts(error_in(sample("no_volume.msh")), {"no tetrahedra", "Physical Volume"});
}

}  // namespace
}  // namespace alphadot
