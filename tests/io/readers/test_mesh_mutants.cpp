// Damaged mesh files: whatever is in one, a reader gives a mesh whose ids are in range or an InputError, and
// takes no more memory than in proportion to the file.
#include <fstream>

#include "io/gmsh_reader.hpp"
#include "io/gzip.hpp"
#include "io/readers/mesh_writers.hpp"
#include "io/su2_reader.hpp"
#include "io/ugrid_reader.hpp"
#include "support/counted_memory.hpp"
#include "support/mutants.hpp"

namespace alphadot {
namespace {

using testing_support::memory;
using testing_support::Random;

using Read = Mesh (*)(const std::string&);

/// A sound file and what reads it.
struct Original {
  const char* format;
  std::string content;
  Read read;
};

template <Encoding encoding>
Mesh read_binary_ugrid(const std::string& content) {
  return read_ugrid(content, "mutant", {.encoding = encoding});
}
Mesh read_any_gmsh(const std::string& content) {
  return read_gmsh(content, "mutant.msh");
}
Mesh read_any_su2(const std::string& content) {
  return read_su2(content, "mutant.su2");
}
template <bool single_reals, bool fortran_records>
Mesh read_other_ugrid(const std::string& content) {
  return read_ugrid(content, "mutant", {Encoding::little_endian, single_reals, fortran_records});
}
Mesh read_text_ugrid(const std::string& content) {
  return read_ugrid(content, "mutant", {});
}

std::vector<Original> originals() {
  return {{"Gmsh 2.2 ASCII", test::gmsh_22(Encoding::text), read_any_gmsh},
          {"Gmsh 2.2 binary", test::gmsh_22(native_encoding), read_any_gmsh},
          {"Gmsh 2.2 swapped", test::gmsh_22(swapped_encoding, true), read_any_gmsh},
          {"Gmsh 4.1 ASCII", test::gmsh_41(Encoding::text), read_any_gmsh},
          {"Gmsh 4.1 binary", test::gmsh_41(native_encoding), read_any_gmsh},
          {"Gmsh 4.1 swapped", test::gmsh_41(swapped_encoding, true), read_any_gmsh},
          {"SU2", test::su2(), read_any_su2},
          {"UGRID big-endian", test::ugrid(Encoding::big_endian), read_binary_ugrid<Encoding::big_endian>},
          {"UGRID little-endian", test::ugrid(Encoding::little_endian),
           read_binary_ugrid<Encoding::little_endian>}};
}

/// Elements of all shapes, in the forms that the originals above do not have.
std::vector<Original> mixed_originals() {
  using testing_support::Column;
  const auto mesh = testing_support::mixed_mesh(
      {.cubes = {2, 2, 1}, .columns = {Column::hexahedra, Column::prisms, Column::middles}, .seed = 5});
  const auto gmsh = [&](const test::GmshDialect& dialect) {
    return Original{dialect.version, test::gmsh_mixed(mesh, dialect), read_any_gmsh};
  };
  std::ifstream file(std::string(ALPHADOT_TEST_DATA) + "/data/partitioned_ghosts_41.msh", std::ios::binary);
  const std::string partitioned(std::istreambuf_iterator<char>(file), {});
  return {gmsh({.version = "1", .named = false}),
          gmsh({.version = "2.0"}),
          gmsh({.version = "2.2", .encoding = native_encoding}),
          gmsh({.version = "4.0"}),
          gmsh({.version = "4.0", .encoding = native_encoding}),
          gmsh({.version = "4.1", .curved = true}),
          gmsh({.version = "4.1", .encoding = swapped_encoding}),
          {"partitioned", partitioned, read_any_gmsh},
          {"SU2", test::su2_mixed(mesh, {.exponent = 'D', .quote = "'"}), read_any_su2},
          {"UGRID text", test::ugrid_mixed(mesh, {}), read_text_ugrid},
          {"UGRID lb8", test::ugrid_mixed(mesh, {Encoding::little_endian, false, false}),
           read_other_ugrid<false, false>},
          {"UGRID lb4", test::ugrid_mixed(mesh, {Encoding::little_endian, true, false}),
           read_other_ugrid<true, false>},
          {"UGRID lr8", test::ugrid_mixed(mesh, {Encoding::little_endian, false, true}),
           read_other_ugrid<false, true>}};
}

/// Expects point ids in range.
void check_ids(const Mesh& mesh) {
  const auto check = [&](const auto& ids) {
    for (const GlobalIndex id : ids)
      ASSERT_TRUE(id >= 0 && id < static_cast<GlobalIndex>(mesh.points.size()));
  };
  for (const auto& cell : mesh.cells) check(cell);
  for (const Patch& patch : mesh.patches)
    for (const auto& triangle : patch.triangles) check(triangle);
}

/// What io/bounded_growth.hpp promises of every block.
std::size_t largest_block(const std::string& content) {
  return 2 * content.size() + 16384;
}

TEST(MeshMutants, GiveAMeshOrAnInputErrorWithinBoundedMemory) {
  constexpr int mutants = 20000;
  // Room for small lists, names and messages, whatever the file.
  constexpr std::size_t fixed = 4096;
  const std::vector<Original> files = originals();
  Random random(20240229);
  int read = 0, refused = 0;
  double largest_share = 0;
  for (int i = 0; i < mutants; ++i) {
    const Original& original = files[static_cast<std::size_t>(i) % files.size()];
    const std::string content = testing_support::mutant(original.content, random);
    SCOPED_TRACE(testing::Message() << "mutant " << i << " of " << original.format);

    const std::size_t before = memory.in_use;
    memory.reset();
    try {
      check_ids(original.read(content));
      ++read;
    } catch (const InputError& error) {
      EXPECT_STRNE(error.what(), "");
      ++refused;
    }
    const std::size_t taken = memory.peak - before;
    EXPECT_LE(taken, 2 * content.size() + fixed) << content.size() << " bytes of file";
    EXPECT_EQ(memory.in_use, before) << "memory is lost";
    largest_share =
        std::max(largest_share, static_cast<double>(taken) / static_cast<double>(fixed + content.size()));
  }
  EXPECT_EQ(read + refused, mutants);
  // Most changes are noticed, yet some (a digit of a coordinate) make another good file.
  EXPECT_GT(refused, mutants / 2);
  EXPECT_GT(read, mutants / 50);
  RecordProperty("read", read);
  RecordProperty("largest_share_of_file_and_4_KiB", std::to_string(largest_share));
}

/// Elements that are cut take more: a hexahedron, 32 bytes in a file and 64 read, makes six tetrahedra of 32
/// bytes, or twelve about an inner point. No block is larger than twelve times the file.
TEST(MeshMutants, OfMixedElementsGiveAMeshOrAnInputErrorWithinBoundedMemory) {
  const std::vector<Original> files = mixed_originals();
  Random random(20250301);
  for (const Original& original : files) {
    int read = 0, refused = 0;
    ASSERT_NO_THROW(original.read(original.content)) << original.format;
    for (int i = 0; i < 2000; ++i) {
      const std::string content = testing_support::mutant(original.content, random);
      SCOPED_TRACE(testing::Message() << "mutant " << i << " of " << original.format);
      const std::size_t before = memory.in_use;
      memory.reset();
      try {
        check_ids(original.read(content));
        ++read;
      } catch (const InputError& error) {
        EXPECT_STRNE(error.what(), "");
        ++refused;
      }
      EXPECT_LE(memory.largest, 12 * content.size() + 16384);
      EXPECT_EQ(memory.in_use, before) << "memory is lost";
    }
    EXPECT_GT(refused, 400) << original.format;
    EXPECT_GT(read, 5) << original.format;
  }
}

TEST(MeshMutants, OfCompressedFilesAreNoticed) {
  std::ifstream file(std::string(ALPHADOT_TEST_DATA) + "/data/compressed.msh.gz", std::ios::binary);
  const std::string sound(std::istreambuf_iterator<char>(file), {});
  ASSERT_FALSE(read_gmsh(gunzip(sound, "mutant"), "mutant").cells.empty());
  Random random(20250301);
  int noticed = 0;
  for (int i = 0; i < 2000; ++i) {
    const std::string content = testing_support::mutant(sound, random);
    memory.reset();
    try {
      read_gmsh(gunzip(content, "mutant.msh.gz"), "mutant.msh.gz");
    } catch (const InputError& error) {
      EXPECT_STRNE(error.what(), "");
      ++noticed;
    }
    EXPECT_LE(memory.largest, 100 * content.size() + (std::size_t{2} << 20));
  }
  // The checksum tells; only what gzip passes over (name, time, system) may change without notice.
  EXPECT_GT(noticed, 1800);
}

TEST(MeshMutants, OfNamesGiveNamesOrAnInputError) {
  for (const std::string sound :
       {"3\n1 4000 wing upper\n2  5000  farfield\r\n7 6662\n",
        "# USM3D\n# id bc family surf ids name\n1 4 4 0 0 wing upper\n3 3 3 0 0 far\n"}) {
    Random random(20240229);
    int read = 0;
    for (int i = 0; i < 2000; ++i) {
      const std::string content = testing_support::mutant(sound, random);
      memory.reset();
      try {
        read_mapbc(content, "mutant.mapbc");
        ++read;
      } catch (const InputError& error) {
        EXPECT_STRNE(error.what(), "");
      }
      EXPECT_LE(memory.largest, largest_block(content)) << content;
    }
    EXPECT_GT(read, 200);
    EXPECT_LT(read, 1900);
  }
}

std::string repeated(const std::string& text, int count) {
  std::string out;
  for (int i = 0; i < count; ++i) out += text;
  return out;
}

std::string numbered(int count) {
  std::string out;
  for (int i = 1; i <= count; ++i) out += std::to_string(i) + "\n";
  return out;
}

/// Text whose numbers are as short as they can be costs the most memory for its length: what may be a mesh is
/// read, what repeats its points or elements without an end is refused before it takes more.
TEST(MeshMutants, ShortNumbersStayWithinBoundedMemory) {
  constexpr int count = 100'000;
  const std::string n = std::to_string(count), gmsh_41 = "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n",
                    gmsh_22 = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n";
  const auto nodes = [&](const std::string& tags) {
    return "$Nodes\n1 " + n + " 1 1\n3 1 0 " + n + "\n" + tags + repeated("0 0 0\n", count) + "$EndNodes\n";
  };
  const std::string elements =
      "$Elements\n1 " + n + " 1 1\n3 1 4 " + n + "\n" + repeated("1 1 2 3 4\n", count);
  const std::string five_nodes =
      "$Nodes\n5\n" + repeated("0 0 0\n", 0) + "1 0 0 0\n2 0 0 0\n3 0 0 0\n4 0 0 0\n5 0 0 0\n$EndNodes\n";
  const struct {
    const char* what;
    std::string content;
    bool is_mesh;
  } files[] = {
      {"x.msh", gmsh_41 + nodes(numbered(count)) + elements + "$EndElements\n", true},
      {"same tags.msh", gmsh_41 + nodes(repeated("1\n", count)) + elements + "$EndElements\n", false},
      {"cells.msh",
       gmsh_22 + five_nodes + "$Elements\n" + n + "\n" + repeated("1 4 0 1 2 3 4\n", count) +
           "$EndElements\n",
       false},
      {"groups.msh",
       gmsh_41 + "$Entities\n0 0 1 0\n1 0 0 0 0 0 0 " + n + " " + repeated("1 ", count) + "0\n$EndEntities\n",
       false},
      {"names.msh", gmsh_41 + "$PhysicalNames\n" + n + "\n" + repeated("2 1 \"\"\n", count), false},
      {"points.su2",
       "NDIME= 3\nNELEM= 1\n10 0 1 2 3\nNPOIN= " + n + "\n" + repeated("0 0 0\n", count) + "NMARK= 0\n",
       false},
      {"cells.su2",
       "NDIME= 3\nNPOIN= 4\n" + repeated("0 0 0\n", 4) + "NELEM= " + n + "\n" +
           repeated("10 0 1 2 3\n", count) + "NMARK= 0\n",
       false}};
  for (const auto& [name, content, is_mesh] : files) {
    SCOPED_TRACE(name);
    const std::size_t before = memory.in_use;
    memory.reset();
    const auto read = [&, file = std::string(name)] {
      return file.ends_with(".su2") ? read_su2(content, file) : read_gmsh(content, file);
    };
    if (is_mesh)
      EXPECT_EQ(read().cells.size(), static_cast<std::size_t>(count));
    else
      EXPECT_THROW(read(), InputError);
    EXPECT_LE(memory.largest, largest_block(content));
    EXPECT_LE(memory.peak - before, 4 * content.size());
  }
}

}  // namespace
}  // namespace alphadot
