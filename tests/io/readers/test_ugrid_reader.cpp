// read_ugrid and read_mapbc on sound and broken files.
#include "io/ugrid_reader.hpp"

#include "io/readers/small_meshes.hpp"

namespace alphadot {
namespace {

using test::expect_parts;
using test::ugrid;

Mesh read(const std::string& content, Encoding encoding, const SurfaceNames& names = {}) {
  return read_ugrid(content, "mesh", {.encoding = encoding}, names);
}

std::string error_in(const std::string& content, Encoding encoding = Encoding::big_endian) {
  return test::error_of([&] { read_ugrid(content, "mesh.b8.ugrid", {.encoding = encoding}); });
}

/// The big-endian mesh with another integer at `byte`.
std::string with_int(std::size_t byte, std::int32_t value) {
  return ugrid(Encoding::big_endian)
      .replace(byte, 4, test::Writer(Encoding::big_endian).ints({value}).content());
}

constexpr std::size_t points_start = 4 * 7;
constexpr std::size_t triangles_start = points_start + 5 * 24;
constexpr std::size_t ids_start = triangles_start + 6 * 12;
constexpr std::size_t cells_start = ids_start + 6 * 4;

TEST(UgridReader, ReadsEitherByteOrder) {
  for (const Encoding encoding : {Encoding::big_endian, Encoding::little_endian})
    test::expect_two_cells(read(ugrid(encoding), encoding), "patch_1", "patch_2");
}

TEST(UgridReader, TakesNamesAndJoinsSurfacesOfOneName) {
  const std::string content = ugrid(Encoding::big_endian);
  test::expect_two_cells(read(content, Encoding::big_endian, {{1, "wall"}, {3, "none"}}), "wall", "patch_2");
  const Mesh joined = read(content, Encoding::big_endian, {{1, "wall"}, {2, "wall"}});
  ASSERT_EQ(joined.patches.size(), 1u);
  EXPECT_EQ(joined.patches[0].triangles.size(), 6u);
}

TEST(UgridReader, SurfaceIdsMayAlternate) {
  const Mesh mesh = read(with_int(ids_start + 4, 2), Encoding::big_endian);
  ASSERT_EQ(mesh.patches.size(), 2u);
  EXPECT_EQ(mesh.patches[0].triangles.size(), 2u);
  EXPECT_EQ(mesh.patches[1].triangles.size(), 4u);
}

TEST(UgridReader, PassesOverWhatFollowsTheCells) {
  const std::string content = ugrid(Encoding::big_endian) + std::string(9, '\xff');
  test::expect_two_cells(read(content, Encoding::big_endian), "patch_1", "patch_2");
}

TEST(UgridErrors, Headers) {
  expect_parts(error_in(ugrid(Encoding::little_endian)), {"little-endian", "extension .lb8.ugrid"});
  expect_parts(error_in(ugrid(Encoding::big_endian), Encoding::little_endian),
               {"big-endian", "extension .b8.ugrid"});
  for (std::size_t i = 0; i < 7; ++i)
    for (const std::int32_t count : {-1, 100, 0x7fffffff})
      expect_parts(error_in(with_int(4 * i, count)),
                   {"mesh.b8.ugrid: the header announces more than", "bytes"});
  expect_parts(error_in(with_int(12, 0)), {"no volume elements"});
}

TEST(UgridErrors, Records) {
  expect_parts(error_in(with_int(points_start, 0x7ff00000)),
               {"x of a point is not a finite number", "byte 28"});
  expect_parts(error_in(with_int(triangles_start, 6)), {"point 6 of 5", "byte 148"});
  expect_parts(error_in(with_int(cells_start + 4, 0)), {"point 0 of 5"});
}

TEST(UgridErrors, TooManyPatches) {
  const auto as_many_as_triangles = [](std::int32_t count) {
    test::Writer writer(Encoding::big_endian);
    writer.ints({4, count, 0, 1, 0, 0, 0}).reals({0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1});
    for (std::int32_t i = 0; i < count; ++i) writer.ints({1, 2, 3});
    for (std::int32_t i = 0; i < count; ++i) writer.ints({i});
    return writer.ints({1, 2, 3, 4}).content();
  };
  expect_parts(error_in(as_many_as_triangles(100'000)), {"more than 10000 boundary patches"});
  // In 28 + 96 + 1,000 * 16 + 16 bytes: one for each 128 of them, and 64.
  expect_parts(error_in(as_many_as_triangles(1000)), {"more than 190 boundary patches"});
}

TEST(UgridErrors, Truncation) {
  const std::string content = ugrid(Encoding::big_endian);
  for (std::size_t size = 0; size < content.size(); ++size)
    EXPECT_NE(error_in(content.substr(0, size)), "") << "cut after " << size << " bytes";
}

TEST(Mapbc, ReadsNames) {
  const SurfaceNames names = read_mapbc("3\n1 4000 wing upper\n2  5000  farfield\r\n7 6662\n", "mesh.mapbc");
  EXPECT_EQ(names, (SurfaceNames{{1, "wing upper"}, {2, "farfield"}}));
}

// The three forms of one set of names that were found among public files.
TEST(Mapbc, ReadsOtherForms) {
  const SurfaceNames one_word{{1, "body"}, {2, "symmetry"}, {3, "farfield"}};
  EXPECT_EQ(read_mapbc("3\n1 4000 ! body\n2 6662 ! symmetry\n3 5000 ! farfield\n", "a.mapbc"), one_word);
  EXPECT_EQ(read_mapbc("\xef\xbb\xbf! by hand\n3\n# id\n1 4000 body ! its nose too\n2 6662 symmetry # y = 0\n"
                       "3 5000 farfield\n",
                       "a.mapbc"),
            one_word);
  EXPECT_EQ(read_mapbc("# date\n# converted\n# remap\n# patch no. bc family surfs surfids name\n"
                       "1 4 4 0 0 body\n2 1 1 0 0 symmetry\n3 3 3 0 0 farfield\n\n",
                       "a.mapbc"),
            one_word);
  EXPECT_EQ(read_mapbc("2\n1 4000 the body\n2 6662  the  plane \t\n", "a.mapbc"),
            (SurfaceNames{{1, "the body"}, {2, "the  plane"}}));
}

TEST(Mapbc, RefusesDamagedFiles) {
  const auto error = [](const char* content) {
    return test::error_of([&] { read_mapbc(content, "mesh.mapbc"); });
  };
  expect_parts(error(""), {"mesh.mapbc:1: "});
  expect_parts(error("30\n1 4000 wing\n"), {"the number of surfaces is 30"});
  expect_parts(error("2\n1 4000 wing\n"), {"mesh.mapbc:3: ", "a surface id"});
  expect_parts(error("1\nwing 4000\n"), {"mesh.mapbc:2: ", "'wing'"});
}

}  // namespace
}  // namespace alphadot
