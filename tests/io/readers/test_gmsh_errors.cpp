// read_gmsh on broken files: every class of mistake with its place and remedy.
#include "io/gmsh_reader.hpp"
#include "io/readers/small_meshes.hpp"

namespace alphadot {
namespace {

using test::expect_parts;
using test::gmsh_22;
using test::gmsh_41;
using test::with;

std::string error_in(const std::string& content) {
  return test::error_of([&] { read_gmsh(content, "mesh.msh"); });
}
std::string text_22() {
  return gmsh_22(Encoding::text);
}
std::string text_41() {
  return gmsh_41(Encoding::text);
}

TEST(GmshErrors, Format) {
  expect_parts(error_in(""), {"mesh.msh:1: ", "a section such as $Nodes"});
  expect_parts(error_in("$NOD\n"), {"mesh.msh:2: ", "the number of nodes"});
  for (const char* version : {"0.9", "3", "4.2", "5.0", "2.2x", "x"})
    expect_parts(error_in(with(text_41(), "4.1 0", version + std::string(" 0"))),
                 {"mesh.msh:2: ", quoted(version), "only 1, 2 to 2.2, 4 and 4.1", "-format msh41"});
  expect_parts(error_in(with(text_22(), "2.2 0 8", "2.2 0 4")), {"mesh.msh:2: ", "data size"});
  std::string binary = gmsh_41(native_encoding);
  binary[binary.find("8\n") + 2] = 3;
  expect_parts(error_in(binary), {"the integer 1", "byte"});
}

TEST(GmshErrors, Sections) {
  expect_parts(error_in(with(text_41(), "$PhysicalNames", "PhysicalNames")),
               {"mesh.msh:4: ", "'PhysicalNames'"});
  expect_parts(error_in(with(text_41(), "$EndNodes", "$EndElements")), {"$EndNodes should stand here"});
  expect_parts(error_in(text_41() + "$Extra\n1 2 3\n"), {"'$Extra' has no end"});
  expect_parts(error_in(with(text_41(), "\"wall\"", "wall")), {"mesh.msh:6: ", "double quotes"});
  expect_parts(error_in(text_22() + "$Nodes\n0\n$EndNodes\n"), {"a second $Nodes section"});
  expect_parts(error_in("$MeshFormat\n4.1 0 8\n$EndMeshFormat\n"), {"no volume elements", "Physical Volume"});
}

TEST(GmshErrors, Truncation) {
  for (const Encoding encoding : {Encoding::text, native_encoding})
    for (const std::string& content : {gmsh_22(encoding), gmsh_41(encoding)})
      // The line end after the last section may be missing.
      for (std::size_t size = 0; size + 1 < content.size(); ++size)
        EXPECT_NE(error_in(content.substr(0, size)), "") << "cut after " << size << " bytes";
}

TEST(GmshErrors, Numbers) {
  expect_parts(error_in(with(text_22(), "5 1.000000", "5 nan")),
               {"mesh.msh:16: x of a point is not a finite number"});
  expect_parts(error_in(with(text_22(), "5 1.000000", "5 1e999")), {"mesh.msh:16: ", "out of range"});
  expect_parts(error_in(with(text_22(), "5 1.000000", "five 1")), {"mesh.msh:16: a node tag", "'five'"});
  const std::string one = test::Writer(native_encoding).reals({1}).content();
  const std::string infinity = test::Writer(native_encoding).reals({HUGE_VAL}).content();
  const std::string binary = gmsh_22(native_encoding);
  expect_parts(error_in(with(binary, one, infinity)),
               {"mesh.msh: x of a point is not a finite number", "byte"});
}

TEST(GmshErrors, Counts) {
  expect_parts(error_in(with(text_22(), "$Nodes\n5", "$Nodes\n1000000000000")),
               {"mesh.msh:11: ", "number of nodes"});
  expect_parts(error_in(with(text_22(), "$Nodes\n5", "$Nodes\n-5")), {"mesh.msh:11: ", "negative"});
  expect_parts(error_in(with(text_22(), "$Elements\n9", "$Elements\n999999999")), {"number of elements"});
  expect_parts(error_in(with(text_22(), "$Elements\n9", "$Elements\n10")),
               {"an element tag", "'$EndElements'"});
  expect_parts(error_in(with(text_22(), "$Elements\n9", "$Elements\n8")), {"$EndElements should stand here"});
  expect_parts(error_in(with(text_22(), "8 4 2 3 1", "8 4 -2 3 1")), {"number of tags", "negative"});
  expect_parts(error_in(with(text_41(), "$Nodes\n2 5", "$Nodes\n2 6")), {"hold 5 nodes", "announces 6"});
  expect_parts(error_in(with(text_41(), "$Elements\n4 9", "$Elements\n4 8")),
               {"hold 9 elements", "announces 8"});
  expect_parts(error_in(with(text_41(), "$Nodes\n2 5", "$Nodes\n2000000000 5")), {"number of blocks"});
  expect_parts(error_in(with(text_41(), "$Entities\n1 1 2", "$Entities\n1 1 -2")), {"number of entities"});

  const auto longs = [](std::int64_t value) {
    return test::Writer(native_encoding).longs({value}).content();
  };
  const std::string binary = gmsh_41(native_encoding);
  expect_parts(error_in(with(binary, "$Nodes\n" + longs(2) + longs(5), "$Nodes\n" + longs(2) + longs(-1))),
               {"negative"});
  expect_parts(
      error_in(with(binary, "$Nodes\n" + longs(2) + longs(5), "$Nodes\n" + longs(2) + longs(1LL << 60))),
      {"bytes left"});
  const auto ints = [](std::initializer_list<std::int32_t> values) {
    return test::Writer(native_encoding).ints(values).content();
  };
  const std::string run = ints({2, 1, 2});
  expect_parts(error_in(with(gmsh_22(native_encoding), run, ints({2, 20, 2}))),
               {"a run of elements goes beyond"});
}

TEST(GmshErrors, Nodes) {
  expect_parts(error_in(with(text_22(), "\n5 1.000000", "\n4 1.000000")),
               {"mesh.msh:10: two nodes have the tag 4"});
  expect_parts(error_in(with(text_22(), "8 4 2 3 1 1 ", "8 4 2 3 1 77 ")), {"mesh.msh:27: ", "node 77"});
  expect_parts(error_in(with(gmsh_22(Encoding::text, true), "\n50 1.000000", "\n40 1.000000")), {"tag 40"});
  const std::string content = text_22();
  const std::size_t nodes = content.find("$Nodes"), elements = content.find("$Elements");
  const std::string reversed =
      content.substr(0, nodes) + content.substr(elements) + content.substr(nodes, elements - nodes);
  expect_parts(error_in(reversed), {"node 1", "no $Nodes section before it"});
}

TEST(GmshErrors, PhysicalGroups) {
  expect_parts(error_in(with(text_41(), "$EndPhysicalNames", "2 7 \"skin\"\n$EndPhysicalNames")),
               {"$EndPhysicalNames"});
  std::string two = with(text_41(), "$PhysicalNames\n3", "$PhysicalNames\n4");
  two = with(two, "$EndPhysicalNames", "2 7 \"skin\"\n$EndPhysicalNames");
  expect_parts(error_in(two), {"surface 10 belongs to two named physical groups, 'wall' and 'skin'"});
}

TEST(GmshErrors, ElementTypes) {
  expect_parts(error_in(with(text_41(), "2 10 2 3 ", "2 10 94 3 ")),
               {"Gmsh's type 94", "tetrahedra, hexahedra, prisms and pyramids"});
  expect_parts(error_in(with(text_41(), "2 10 2 3 ", "2 10 -2 3 ")), {"Gmsh's type -2"});
  expect_parts(error_in(with(text_22(), "8 4 2 3 1 1 2 3 4", "8 5 2 3 1 1 2 3 4")),
               {"mesh.msh:28: ", "node 9"});  // the next numbers are taken for nodes
}

}  // namespace
}  // namespace alphadot
