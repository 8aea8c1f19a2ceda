// read_gmsh on sound files: hand-written ones in both versions and every encoding.
#include "io/gmsh_reader.hpp"

#include <tuple>

#include "io/readers/small_meshes.hpp"

namespace alphadot {
namespace {

using test::gmsh_22;
using test::gmsh_41;
using test::with;

class GmshEncodings : public testing::TestWithParam<std::tuple<Encoding, bool>> {};

TEST_P(GmshEncodings, ReadsBothVersions) {
  const auto [encoding, sparse] = GetParam();
  test::expect_two_cells(read_gmsh(gmsh_22(encoding, sparse), "mesh.msh"), "wall", "far field");
  test::expect_two_cells(read_gmsh(gmsh_41(encoding, sparse), "mesh.msh"), "wall", "far field");
}

INSTANTIATE_TEST_SUITE_P(Gmsh, GmshEncodings,
                         testing::Combine(testing::Values(Encoding::text, native_encoding, swapped_encoding),
                                          testing::Bool()));

TEST(GmshReader, KeepsTheNameOfTheFile) {
  EXPECT_EQ(read_gmsh(gmsh_41(Encoding::text), "a/b.msh").file, "a/b.msh");
}

TEST(GmshReader, PassesOverUnknownSections) {
  for (const Encoding encoding : {Encoding::text, native_encoding})
    for (const std::string& content : {gmsh_22(encoding), gmsh_41(encoding)}) {
      const std::string after =
          content + "$NodeData\n1\n\"p\"\n" + std::string("\0\1\xff", 3) + "\n$EndNodeData\n";
      test::expect_two_cells(read_gmsh(after, "mesh.msh"), "wall", "far field");
      const std::string before = with(content, "$Nodes", "$Periodic\n0\n$EndPeriodic\n$Nodes");
      test::expect_two_cells(read_gmsh(before, "mesh.msh"), "wall", "far field");
    }
}

TEST(GmshReader, TakesTheBoundsOfEmptyEntities) {
  // What %.16g makes of the largest double is larger than it.
  const std::string bounds = "1 0.000000 0.000000 0.000000 1.000000";
  const std::string content = with(gmsh_41(Encoding::text), bounds, "1 1.797693134862316e+308 nan -inf 1");
  test::expect_two_cells(read_gmsh(content, "mesh.msh"), "wall", "far field");
}

TEST(GmshReader, ReadsLineEndsOfWindows) {
  for (const std::string& content : {gmsh_22(Encoding::text), gmsh_41(Encoding::text)}) {
    std::string windows;
    for (const char c : content) windows += c == '\n' ? std::string("\r\n") : std::string(1, c);
    test::expect_two_cells(read_gmsh(windows, "mesh.msh"), "wall", "far field");
  }
}

TEST(GmshReader, DropsPointsThatNothingUses) {
  std::string content = gmsh_22(Encoding::text);
  content = with(content, "$Nodes\n5\n", "$Nodes\n7\n98 5 5 5\n");
  content = with(content, "$EndNodes", "99 6 6 6\n$EndNodes");
  test::expect_two_cells(read_gmsh(content, "mesh.msh"), "wall", "far field");
}

TEST(GmshReader, TurnsLeftHandedCells) {
  // The second node of the first tetrahedron takes the place of the third.
  const std::string content = with(gmsh_22(Encoding::text), "8 4 2 3 1 1 2 3 4", "8 4 2 3 1 1 3 2 4");
  const MeshOfFile mesh = read_gmsh(content, "mesh.msh");
  test::expect_two_cells(mesh, "wall", "far field");
  ASSERT_EQ(mesh.notes.size(), 1u);
  test::expect_parts(mesh.notes[0], {"1 of 2 tetrahedra were left-handed"});
}

TEST(GmshReader, NamesGroupsWithoutNamesByTheirTags) {
  const std::string unnamed = "group_2";
  for (const auto& [content, name] :
       {std::pair{with(gmsh_22(Encoding::text), "2 2 \"far field\"", "1 2 \"far field\""), unnamed},
        std::pair{with(gmsh_41(Encoding::text), "2 2 \"far field\"", "2 9 \"far field\""), unnamed}}) {
    const MeshOfFile mesh = read_gmsh(content, "mesh.msh");
    test::expect_two_cells(mesh, "wall", name);
    ASSERT_EQ(mesh.notes.size(), 1u);
    test::expect_parts(mesh.notes[0], {"physical groups of dimension 2", "group_2"});
  }
}

TEST(GmshReader, NamesSurfacesInNoGroupByTheirTags) {
  std::string content = gmsh_22(Encoding::text);
  for (int i = 0; i < 3; ++i) content = with(content, " 2 2 2 20 ", " 2 2 0 20 ");
  test::expect_two_cells(read_gmsh(content, "mesh.msh"), "wall", "surface_20");
  content = with(gmsh_41(Encoding::text), "1 -2 0 ", "0 0 ");
  test::expect_two_cells(read_gmsh(content, "mesh.msh"), "wall", "surface_20");
}

TEST(GmshReader, TellsTheRegionsOfTheCells) {
  std::string content = gmsh_22(Encoding::text);
  MeshOfFile mesh = read_gmsh(content, "mesh.msh");
  ASSERT_EQ(mesh.volumes.size(), 1u);
  EXPECT_EQ(mesh.volumes[0].name, "fluid");
  mesh = read_gmsh(with(content, "9 4 2 3 1 ", "9 4 2 5 1 "), "mesh.msh");
  ASSERT_EQ(mesh.volumes.size(), 2u);
  EXPECT_EQ(mesh.volumes[1].name, "group_5");
  EXPECT_EQ(mesh.volumes[1].first_cell, 1);
}

TEST(GmshReader, JoinsGroupsOfOneName) {
  const std::string content = with(gmsh_41(Encoding::text), "far field", "wall");
  const MeshOfFile mesh = read_gmsh(content, "mesh.msh");
  ASSERT_EQ(mesh.patches.size(), 1u);
  EXPECT_EQ(mesh.patches[0].triangles.size(), 6u);
}

TEST(GmshReader, ReadsPartitionTagsOfVersion2) {
  // Number of partitions and partition follow the groups.
  const std::string content = with(gmsh_22(Encoding::text), "8 4 2 3 1 ", "8 4 4 3 1 1 1 ");
  test::expect_two_cells(read_gmsh(content, "mesh.msh"), "wall", "far field");
}

}  // namespace
}  // namespace alphadot
