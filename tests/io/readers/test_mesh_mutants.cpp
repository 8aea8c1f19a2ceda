// Damaged mesh files: whatever is in one, a reader gives a mesh whose ids are in range or an InputError, and
// takes no more memory than in proportion to the file.
#include <malloc.h>

#include <atomic>
#include <cstdlib>
#include <new>
#include <random>

#include "io/gmsh_reader.hpp"
#include "io/readers/small_meshes.hpp"
#include "io/su2_reader.hpp"
#include "io/ugrid_reader.hpp"

namespace {

// Bytes in use and their peak. Atomic, because MPI has threads of its own.
std::atomic<std::size_t> in_use{0};
std::atomic<std::size_t> peak{0};

}  // namespace

void* operator new(std::size_t size) {
  void* const block = std::malloc(size);
  if (block == nullptr) throw std::bad_alloc();
  in_use += malloc_usable_size(block);
  peak = std::max(peak.load(), in_use.load());
  return block;
}
void operator delete(void* block) noexcept {
  in_use -= malloc_usable_size(block);
  std::free(block);
}
void operator delete(void* block, std::size_t) noexcept {
  operator delete(block);
}

namespace alphadot {
namespace {

using Read = Mesh (*)(const std::string&);

/// A sound file and what reads it.
struct Original {
  const char* format;
  std::string content;
  Read read;
};

std::vector<Original> originals() {
  const Read gmsh = [](const std::string& content) { return read_gmsh(content, "mutant.msh"); };
  const Read su2 = [](const std::string& content) { return read_su2(content, "mutant.su2"); };
  const Read big = [](const std::string& content) {
    return read_ugrid(content, "mutant", Encoding::big_endian);
  };
  const Read little = [](const std::string& content) {
    return read_ugrid(content, "mutant", Encoding::little_endian);
  };
  return {{"Gmsh 2.2 ASCII", test::gmsh_22(Encoding::text), gmsh},
          {"Gmsh 2.2 binary", test::gmsh_22(native_encoding), gmsh},
          {"Gmsh 2.2 swapped", test::gmsh_22(swapped_encoding, true), gmsh},
          {"Gmsh 4.1 ASCII", test::gmsh_41(Encoding::text), gmsh},
          {"Gmsh 4.1 binary", test::gmsh_41(native_encoding), gmsh},
          {"Gmsh 4.1 swapped", test::gmsh_41(swapped_encoding, true), gmsh},
          {"SU2", test::su2(), su2},
          {"UGRID big-endian", test::ugrid(Encoding::big_endian), big},
          {"UGRID little-endian", test::ugrid(Encoding::little_endian), little}};
}

using Random = std::mt19937;

/// Some place in [0, size); the modulo, unlike a distribution, gives the same with every library.
std::size_t below(std::size_t size, Random& random) {
  return random() % size;
}

/// Changes `content` in one way: bits, bytes, numbers or whole stretches.
void damage(std::string& content, Random& random) {
  if (content.empty()) return;
  const std::size_t place = below(content.size(), random);
  const std::size_t length = std::min(content.size() - place, 1 + below(40, random));
  switch (below(7, random)) {
    case 0:
      content[place] = static_cast<char>(content[place] ^ (1 << below(8, random)));
      break;
    case 1:
      content[place] = static_cast<char>(random());
      break;
    case 2:
      content.resize(place);
      break;
    case 3:
      content.erase(place, length);
      break;
    case 4:
      content.insert(place, content.substr(below(content.size(), random), length));
      break;
    case 5: {
      const char* const words[] = {
          " -1 ", " 2147483647 ", " 9223372036854775807 ", " 1e999 ", " nan ", "\n$Nodes\n", "="};
      const std::string word = words[below(std::size(words), random)];
      content.replace(place, std::min(length, word.size()), word);
      break;
    }
    case 6: {
      const std::int32_t values[] = {-1, 0, 0x7fffffff, -0x7fffffff - 1, 0x7ff00000};
      const std::int32_t value = values[below(std::size(values), random)];
      content.replace(place, std::min<std::size_t>(length, 4),
                      test::Writer(native_encoding).ints({value}).content());
      break;
    }
  }
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
    std::string content = original.content;
    for (std::size_t times = 1 + below(3, random); times > 0; --times) damage(content, random);
    SCOPED_TRACE(testing::Message() << "mutant " << i << " of " << original.format);

    const std::size_t before = in_use;
    peak = before;
    try {
      check_ids(original.read(content));
      ++read;
    } catch (const InputError& error) {
      EXPECT_STRNE(error.what(), "");
      ++refused;
    }
    const std::size_t taken = peak - before;
    EXPECT_LE(taken, 2 * content.size() + fixed) << content.size() << " bytes of file";
    EXPECT_EQ(in_use, before) << "memory is lost";
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

/// A sound text file whose numbers are as short as they can be costs the most memory for its length.
TEST(MeshMutants, ShortNumbersStayWithinBoundedMemory) {
  constexpr int count = 100'000;
  std::string nodes = "$Nodes\n1 " + std::to_string(count) + " 1 1\n3 1 0 " + std::to_string(count) + "\n";
  for (int i = 1; i <= count; ++i) nodes += std::to_string(i) + "\n";
  for (int i = 1; i <= count; ++i) nodes += "0 0 0\n";
  std::string elements =
      "$Elements\n1 " + std::to_string(count) + " 1 1\n3 1 4 " + std::to_string(count) + "\n";
  for (int i = 1; i <= count; ++i) elements += "1 1 2 3 4\n";
  const std::string content =
      "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n" + nodes + "$EndNodes\n" + elements + "$EndElements\n";
  const std::size_t before = in_use;
  peak = before;
  EXPECT_EQ(read_gmsh(content, "short.msh").cells.size(), static_cast<std::size_t>(count));
  EXPECT_LE(peak - before, 4 * content.size());
}

}  // namespace
}  // namespace alphadot
