// Some 800 files: every reader, every mix of elements, every dialect. Each is a box of known volume and
// areas, cut into cubes, whose elements are numbered at random and partly left-handed; what is read must be a
// conforming mesh with the right number of tetrahedra, volume, areas and names.
#include "io/gmsh_reader.hpp"
#include "io/readers/corpus.hpp"
#include "io/su2_reader.hpp"

namespace alphadot {
namespace {

using test::for_each_mesh;
using test::given_names;
using test::numbered;
using testing_support::MixedMesh;

TEST(Corpus, Gmsh) {
  std::vector<test::GmshDialect> dialects{{.version = "1", .named = false},
                                          {.version = "2.0"},
                                          {.version = "2", .before = "\n\n"},
                                          {.version = "2.1", .before = "$Comments\nby hand\n$EndComments\n"},
                                          {.version = "2.2", .before = "\xef\xbb\xbf"},
                                          {.version = "2.2", .curved = true},
                                          {.version = "4", .named = false},
                                          {.version = "4.1", .named = false},
                                          {.version = "4.1", .curved = true}};
  for (const Encoding encoding : {native_encoding, swapped_encoding, Encoding::text})
    for (const char* version : {"2.2", "4.0", "4.1"})
      dialects.push_back({.version = version, .encoding = encoding});
  const int meshes = for_each_mesh([&](const MixedMesh& mesh) {
    for (const auto& dialect : dialects) {
      // The writer knows 4.0 by that name.
      test::GmshDialect d = dialect;
      std::string content;
      if (d.is("4")) {
        d.version = "4.0";
        content = test::with(test::gmsh_mixed(mesh, d), "4.0", "4");
      } else {
        content = test::gmsh_mixed(mesh, d);
      }
      SCOPED_TRACE(testing::Message()
                   << "format " << dialect.version << ", encoding " << static_cast<int>(dialect.encoding)
                   << (dialect.curved ? ", curved" : ""));
      const MeshOfFile read = read_gmsh(content, "corpus.msh");
      test::expect_box(read, mesh, dialect.named ? given_names() : numbered("group_"));
      ASSERT_FALSE(read.volumes.empty());
      EXPECT_EQ(read.volumes.front().name, dialect.named && !d.is("2.0") ? "air" : "group_9");
    }
  });
  EXPECT_GE(meshes * std::ssize(dialects), 450);
}

TEST(Corpus, Su2) {
  const std::vector<test::Su2Dialect> dialects{{},
                                               {.before = "\xef\xbb\xbf% by hand\n", .indices = false},
                                               {.exponent = 'D', .points_first = true},
                                               {.exponent = 'd', .quote = "\""},
                                               {.quote = "'", .line_end = "\r\n"}};
  const int meshes = for_each_mesh([&](const MixedMesh& mesh) {
    for (const auto& dialect : dialects) {
      SCOPED_TRACE(testing::Message() << "dialect " << (&dialect - dialects.data()));
      test::expect_box(read_su2(test::su2_mixed(mesh, dialect), "corpus.su2"), mesh, given_names());
    }
  });
  EXPECT_GE(meshes * std::ssize(dialects), 130);
}

TEST(Corpus, Ugrid) {
  const std::array extensions{".ugrid",    ".b8.ugrid",  ".lb8.ugrid", ".b4.ugrid", ".lb4.ugrid",
                              ".r8.ugrid", ".lr8.ugrid", ".r4.ugrid",  ".lr4.ugrid"};
  const int meshes = for_each_mesh([&](const MixedMesh& mesh) {
    for (const char* extension : extensions) {
      SCOPED_TRACE(extension);
      const UgridForm form = *ugrid_form(extension);
      const std::string content = test::ugrid_mixed(mesh, form);
      const Real tolerance = form.single_reals ? 1e-6 : 1e-12;
      test::expect_box(read_ugrid(content, "corpus", form), mesh, numbered("patch_"), tolerance);
      // What another form would make of it is an error that tells the right one; a file that is cut is
      // damaged, and of no other form.
      for (const char* other : extensions)
        if (form != *ugrid_form(other))
          test::expect_parts(test::error_of([&] { read_ugrid(content, "corpus", *ugrid_form(other)); }),
                             {"the extension " + std::string(extension)});
      if (form.encoding != Encoding::text)
        test::expect_parts(
            test::error_of([&] { read_ugrid(content.substr(0, content.size() - 5), "corpus", form); }),
            {"damaged"});
    }
  });
  EXPECT_GE(meshes * std::ssize(extensions), 240);
}

}  // namespace
}  // namespace alphadot
