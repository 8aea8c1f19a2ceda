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

TEST(GmshReader, KeepsTheOrientationOfCells) {
  // The second node of the first tetrahedron takes the place of the third.
  const std::string content = with(gmsh_22(Encoding::text), "8 4 2 3 1 1 2 3 4", "8 4 2 3 1 1 3 2 4");
  const Mesh mesh = read_gmsh(content, "mesh.msh");
  EXPECT_EQ(mesh.cells[0], (std::array<GlobalIndex, 4>{0, 2, 1, 3}));
  EXPECT_THROW(mesh.validate(), InputError);
}

TEST(GmshReader, JoinsGroupsOfOneName) {
  const std::string content = with(gmsh_41(Encoding::text), "far field", "wall");
  const Mesh mesh = read_gmsh(content, "mesh.msh");
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
