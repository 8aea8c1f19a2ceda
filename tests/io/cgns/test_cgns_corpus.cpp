// Some 130 CGNS files, of every mix of elements, as the corpus of the other readers: what is read must be a
// conforming mesh with the right number of tetrahedra, volume, areas and names.
#include <gmock/gmock.h>

#include "io/cgns/cgns_reader.hpp"
#include "io/cgns/mixed_cgns_file.hpp"
#include "io/cgns/su2_writer.hpp"
#include "io/mesh_reader.hpp"
#include "io/readers/corpus.hpp"
#include "io/temporary_folder.hpp"

namespace alphadot {
namespace {

using testing::HasSubstr;
using testing_support::MixedMesh;

TEST(CgnsCorpus, EveryMixOfElements) {
  const TemporaryFolder folder;
  const std::string path = folder / "mesh.cgns", converted = folder / "mesh.su2";
  const std::vector<test::CgnsDialect> dialects{{.is_mixed = true},
                                                {.is_mixed = true, .is_curved = true},
                                                {.is_mixed = true, .has_families = true},
                                                {.has_families = true},
                                                {.is_curved = true, .has_families = true}};
  const int meshes = test::for_each_mesh([&](const MixedMesh& mixed) {
    for (const auto& dialect : dialects) {
      SCOPED_TRACE(testing::Message() << "dialect " << (&dialect - dialects.data()));
      test::write_cgns(path, mixed, dialect);
      const MeshOfFile mesh = read_cgns(path, [](const std::string& note) { ADD_FAILURE() << note; });
      test::expect_box(mesh, mixed, test::given_names());
      std::string notes;
      for (const auto& note : mesh.notes) notes += note + "\n";
      if (mixed.count(Shape::hexahedron) > 0) {
        EXPECT_THAT(notes, HasSubstr(std::to_string(mixed.count(Shape::hexahedron)) + " hexahedra"));
      }
      EXPECT_EQ(notes.find("of higher order") != std::string::npos, dialect.is_curved);
      if (&dialect != &dialects.front()) continue;
      write_su2(converted, mesh);
      const MeshOfFile again = read_mesh(converted);
      EXPECT_EQ(again.points.size(), mesh.points.size());
      EXPECT_EQ(again.cells, mesh.cells);
    }
  });
  EXPECT_GE(meshes * std::ssize(dialects), 130);
}

}  // namespace
}  // namespace alphadot
