// Damaged CGNS files: whatever is in one, the converter gives a mesh whose ids are in range or an InputError,
// and takes no block of memory out of proportion to the file.
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>
#include <cstdlib>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include "core/error.hpp"
#include "io/cgns/cgns_reader.hpp"
#include "io/cgns/mixed_cgns_file.hpp"
#include "io/temporary_folder.hpp"
#include "support/box_mesh.hpp"
#include "support/counted_memory.hpp"
#include "support/mutants.hpp"

namespace alphadot {
namespace {

using testing_support::memory;

enum class Ending { mesh, refused, wrong };

/// No block may be larger than `share` times the file and 16 KiB.
Ending convert(const std::string& path, std::size_t size, std::size_t share = 2) {
  memory.reset();
  Ending ending = Ending::refused;
  try {
    const Mesh mesh = read_cgns(path, [](const std::string&) {});
    ending = Ending::mesh;
    for (const auto& cell : mesh.cells)
      for (const GlobalIndex point : cell)
        if (point < 0 || point >= std::ssize(mesh.points)) return Ending::wrong;
  } catch (const InputError&) {
    // Refusing is as good.
  }
  return memory.largest <= share * size + 16384 ? ending : Ending::wrong;
}

std::size_t size_of(const std::string& path) {
  return static_cast<std::size_t>(std::filesystem::file_size(path));
}

/// Sound files of nothing but numbers of 32 bits, which take twice as many in memory: the limit is met, by
/// points, by tetrahedra, and by triangles, of which a file may hold any number.
TEST(CgnsMutants, SoundFilesOfTheSmallestNumbersStayWithinTheLimit) {
  const TemporaryFolder folder;
  const std::string path = folder / "mesh.cgns";
  Mesh mesh = testing_support::box_mesh({.cells = {16, 16, 16}, .upper = {1, 1, 1}});
  const auto write = [&](int repetitions) {
    test::CgnsFile file(path);
    file.add_zone<float>(mesh);
    file.add_section("Volume", CGNS_ENUMV(TETRA_4), mesh.cells);
    for (int i = 0; i < repetitions; ++i)
      for (const auto& patch : mesh.patches)
        file.add_section(patch.name + std::to_string(i), CGNS_ENUMV(TRI_3), patch.triangles);
  };
  write(1);
  EXPECT_EQ(convert(path, size_of(path)), Ending::mesh);
  EXPECT_GT(memory.largest, size_of(path));  // the limit is near, and the measure works
  write(20);
  EXPECT_EQ(convert(path, size_of(path)), Ending::mesh);
  mesh.cells.resize(1);
  write(1);
  EXPECT_EQ(convert(path, size_of(path)), Ending::mesh);
}

/// 500, for each takes a twentieth of a second; MUTANTS in the environment asks for more.
int number_of_mutants() {
  const char* asked = std::getenv("MUTANTS");
  return asked ? std::atoi(asked) : 500;
}

/// Each mutant in a process of its own, as the converter is: after an error the CGNS library gives errors for
/// sound files too. Of a thousand more than `fewest` are to be read: as few as that would be no test of the
/// reading.
void expect_meshes_or_errors(const std::string& path, std::size_t share, int fewest) {
  const int mutants = number_of_mutants();
  std::ifstream in(path, std::ios::binary);
  const std::string content(std::istreambuf_iterator<char>(in), {});
  testing_support::Random random(20240229);
  int meshes = 0, refused = 0;
  for (int i = 0; i < mutants; ++i) {
    SCOPED_TRACE(testing::Message() << "mutant " << i);
    const std::string mutant = testing_support::mutant(content, random);
    std::ofstream(path, std::ios::binary) << mutant;
    const pid_t child = fork();
    ASSERT_GE(child, 0);
    if (child == 0) _exit(static_cast<int>(convert(path, mutant.size(), share)));
    int status = 0;
    ASSERT_EQ(waitpid(child, &status, 0), child);
    ASSERT_TRUE(WIFEXITED(status)) << "ended by signal " << WTERMSIG(status);
    const auto ending = static_cast<Ending>(WEXITSTATUS(status));
    EXPECT_NE(ending, Ending::wrong);
    meshes += ending == Ending::mesh;
    refused += ending == Ending::refused;
  }
  EXPECT_GT(1000 * meshes, fewest * mutants);
  EXPECT_GT(1000 * refused, 400 * mutants);
}

TEST(CgnsMutants, GiveAMeshOrAnInputError) {
  const TemporaryFolder folder;
  const std::string path = folder / "mesh.cgns";
  {
    const Mesh mesh = testing_support::box_mesh({.cells = {2, 2, 2}, .upper = {1, 1, 1}});
    test::CgnsFile file(path);
    file.add_zone(mesh);
    file.add_section("Volume", CGNS_ENUMV(TETRA_4), mesh.cells);
    for (const auto& patch : mesh.patches) file.add_section(patch.name, CGNS_ENUMV(TRI_3), patch.triangles);
  }
  expect_meshes_or_errors(path, 2, 10);
}

/// As of the other readers, a hexahedron makes tetrahedra of twelve times its bytes at most.
TEST(CgnsMutants, OfMixedElementsGiveAMeshOrAnInputError) {
  using testing_support::Column;
  const TemporaryFolder folder;
  const std::string path = folder / "mesh.cgns";
  test::write_cgns(
      path,
      testing_support::mixed_mesh(
          {.cubes = {2, 2, 1}, .columns = {Column::hexahedra, Column::prisms, Column::middles}, .seed = 5}),
      {.is_mixed = true, .has_families = true});
  expect_meshes_or_errors(path, 12, 2);
}

}  // namespace
}  // namespace alphadot
