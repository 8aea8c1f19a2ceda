// read_su2 on sound and broken files.
#include "io/su2_reader.hpp"

#include "io/readers/small_meshes.hpp"

namespace alphadot {
namespace {

using test::expect_parts;
using test::su2;
using test::with;

std::string error_in(const std::string& content) {
  return test::error_of([&] { read_su2(content, "mesh.su2"); });
}

/// The lines of `content` from the one that starts with `first` up to the one that starts with `end`.
std::string cut(std::string& content, const std::string& first, const std::string& end) {
  const std::size_t begin = content.find(first);
  const std::size_t size = std::min(content.find(end), content.size()) - begin;
  const std::string part = content.substr(begin, size);
  content.erase(begin, size);
  return part;
}

TEST(Su2Reader, ReadsMarkersAsPatches) {
  const MeshOfFile mesh = read_su2(su2(), "a/mesh.su2");
  test::expect_two_cells(mesh, "wall", "far_field");
  EXPECT_EQ(mesh.file, "a/mesh.su2");
}

TEST(Su2Reader, TakesSectionsInAnyOrder) {
  std::string content = su2();
  const std::string cells = cut(content, "NELEM", "NPOIN");
  test::expect_two_cells(read_su2(content + cells, "mesh.su2"), "wall", "far_field");
  const std::string markers = cut(content, "NMARK", "% end");
  const std::string points = cut(content, "NPOIN", "% end");
  test::expect_two_cells(read_su2(markers + points + cells + content, "mesh.su2"), "wall", "far_field");
}

TEST(Su2Reader, IndicesAndBlanksAreFree) {
  std::string content = su2();
  for (const char* index : {"0 0 0 0\n", "1 0 0 1\n", "0 1 0 2\n", "0 0 1 3\n", "1 1 1 4\n"})
    content = with(content, index, std::string(index, 5) + " \n");
  content = with(content, "10 0 1 2 3 0\n", "10\t0 1 2 3 % first\n\n% then\n");
  content = with(content, "NPOIN= 5", "  NPOIN =5 5");
  content = with(content, "NELEM= 2", "NELEM=2");
  content = with(content, "MARKER_TAG= wall", "MARKER_TAG=wall % slip");
  content = with(content, "5 0 1 2\n", "5 0 1 2 0\r\n");
  test::expect_two_cells(read_su2(content, "mesh.su2"), "wall", "far_field");
}

TEST(Su2Reader, PassesOverOtherKeywords) {
  const std::string box = "FFD_NBOX= 1\nFFD_CORNER_POINTS= 2\n0.0 0.0 0.0\n1.0 0.0 0.0\nAOA_OFFSET= 0.0\n";
  test::expect_two_cells(read_su2(su2() + box, "mesh.su2"), "wall", "far_field");
  test::expect_two_cells(read_su2("NZONE= 1\n" + box + su2(), "mesh.su2"), "wall", "far_field");
}

TEST(Su2Reader, KeepsMarkersWithoutElements) {
  const Mesh mesh =
      read_su2(with(su2(), "NMARK= 2", "NMARK= 3") + "MARKER_TAG= hub\nMARKER_ELEMS= 0\n", "mesh.su2");
  ASSERT_EQ(mesh.patches.size(), 3u);
  EXPECT_EQ(mesh.patches[2].name, "hub");
}

TEST(Su2Reader, TakesWhatOtherProgramsWrite) {
  test::expect_two_cells(read_su2("\xef\xbb\xbf" + su2(), "mesh.su2"), "wall", "far_field");
  for (const char* one : {"1.0D+00", "1.d0", "10.0D-1", "+1.0D+00", "0.1E+01"})
    test::expect_two_cells(read_su2(with(su2(), "1 1 1 4", one + std::string(" 1 1 4")), "mesh.su2"), "wall",
                           "far_field");
  for (const char* name : {"far field", "\"far field\"", "'far field'  ", "far field % rest\r"})
    test::expect_two_cells(read_su2(with(su2(), "far_field", name), "mesh.su2"), "wall", "far field");
  std::string halo = with(su2(), "NMARK= 2", "NMARK= 4");
  for (const int to : {2, -2})
    halo += "MARKER_TAG= SEND_RECEIVE\nMARKER_ELEMS= 2\nSEND_TO= " + std::to_string(to) + "\n1 3 0\n1 4 0\n";
  const MeshOfFile mesh = read_su2(halo, "mesh.su2");
  test::expect_two_cells(mesh, "wall", "far_field");
  ASSERT_EQ(mesh.notes.size(), 1u);
  expect_parts(mesh.notes[0], {"2 markers SEND_RECEIVE"});
}

TEST(Su2Errors, Numbers) {
  for (const char* number : {"1.0D", "1.0D+", "1.0Dx", "D+00", "1.0D+00x", "1.0Q+00"})
    expect_parts(error_in(with(su2(), "1 1 1 4", number + std::string(" 1 1 4"))),
                 {"mesh.su2:11: x of a point"});
}

TEST(Su2Errors, OtherMeshes) {
  expect_parts(error_in(""), {"mesh.su2:1: there is no NPOIN"});
  expect_parts(error_in(with(su2(), "NDIME= 3", "NDIME= 2")),
               {"mesh.su2:2: ", "the mesh is two-dimensional", "extrude"});
  expect_parts(error_in(with(su2(), "NDIME= 3", "NDIME= 4")), {"mesh.su2:2: ", "not three-dimensional"});
  expect_parts(error_in(with(su2(), "NDIME= 3\n", "")), {"no NDIME= 3"});
  expect_parts(error_in("NZONE= 2\n" + su2()), {"mesh.su2:1: ", "several zones"});
  expect_parts(error_in(with(su2(), "10 0 1 2 3 0", "5 0 1 2")), {"mesh.su2:4: ", "SU2's type 5", "(10)"});
  expect_parts(error_in(with(su2(), "5 0 1 2\n", "10 0 1 2 3\n")), {"mesh.su2:15: ", "SU2's type 10", "(9)"});
  expect_parts(error_in(with(su2(), "5 0 1 2\n", "1 0\n")), {"mesh.su2:15: ", "SU2's type 1 "});
  std::string no_cells = su2();
  cut(no_cells, "NELEM", "NPOIN");
  expect_parts(error_in(no_cells), {"no volume elements", "NELEM"});
}

TEST(Su2Errors, Structure) {
  expect_parts(error_in(with(su2(), "NELEM= 2", "NELEM= 1")),
               {"mesh.su2:5: a keyword such as NELEM=", "'10'"});
  expect_parts(error_in(with(su2(), "NELEM= 2", "NELEM= 3")), {"mesh.su2:6: an element type", "'NPOIN='"});
  expect_parts(error_in(with(su2(), "NELEM= 2", "NELEM= 200000")), {"mesh.su2:3: the number of elements"});
  expect_parts(error_in(with(su2(), "NPOIN= 5", "NPOIN= -5")), {"point 0 of -5"});
  expect_parts(error_in(with(su2(), "NPOIN= 5", "NPOIN= 99999999999")), {"mesh.su2:6: the number of points"});
  expect_parts(error_in(with(su2(), "NMARK= 2", "NMARK= 3")), {"3 markers, but there are 2"});
  expect_parts(error_in(with(su2(), "NMARK= 2\n", "")), {"no NMARK"});
  expect_parts(error_in(with(su2(), "MARKER_TAG= wall\n", "")), {"MARKER_ELEMS without a MARKER_TAG"});
  expect_parts(error_in(with(su2(), "wall", "% none")), {"mesh.su2:13: a marker has no name"});
  expect_parts(error_in(with(su2(), "far_field", "wall")), {"a second marker 'wall'"});
  expect_parts(error_in(su2() + "MARKER_TAG= a\nMARKER_TAG= b\n"), {"marker 'a' has no MARKER_ELEMS"});
  expect_parts(error_in(su2() + "MARKER_TAG= a\n"), {"marker 'a' has no MARKER_ELEMS"});
  expect_parts(error_in(su2() + "NPOIN= 1\n0 0 0\n"), {"a second NPOIN section"});
}

TEST(Su2Errors, Records) {
  expect_parts(error_in(with(su2(), "10 0 1 2 3 0", "10 0 1 2 5 0")), {"mesh.su2:4: ", "point 5 of 5"});
  expect_parts(error_in(with(su2(), "5 0 1 2\n", "5 0 -1 2\n")), {"mesh.su2:15: ", "point -1 of 5"});
  expect_parts(error_in(with(su2(), "10 0 1 2 3 0", "10 0 1 2 3 0 7")),
               {"mesh.su2:4: the line should end before '7'"});
  expect_parts(error_in(with(su2(), "0 1 0 2", "0 1 0 3")), {"mesh.su2:9: point 2 has the index 3"});
  expect_parts(error_in(with(su2(), "0 1 0 2", "0 nan 0 2")), {"mesh.su2:9: y of a point is not a finite"});
  expect_parts(error_in(with(su2(), "0 1 0 2", "0 1e400 0 2")), {"mesh.su2:9: y of a point is out of range"});
}

TEST(Su2Errors, Truncation) {
  const std::string content = su2();
  // The last line may do without its end.
  for (std::size_t size = 0; size + 1 < content.size(); ++size)
    EXPECT_NE(error_in(content.substr(0, size)), "") << "cut after " << size << " bytes";
}

}  // namespace
}  // namespace alphadot
