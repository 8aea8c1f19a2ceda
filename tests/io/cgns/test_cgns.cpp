// CGNS files that the CGNS library wrote: the converter reads the mesh that was written, and the solver's
// reader finds the same one in the SU2 file. Samples for the test of the program (test_program.py) are left
// in ALPHADOT_SAMPLES, each with the hash of its mesh.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <functional>
#include <numeric>

#include "core/error.hpp"
#include "io/cgns/cgns_file.hpp"
#include "io/cgns/cgns_reader.hpp"
#include "io/cgns/su2_writer.hpp"
#include "io/mesh_reader.hpp"
#include "io/temporary_folder.hpp"
#include "support/box_mesh.hpp"

namespace alphadot {
namespace {

using test::CgnsFile;
using testing::AllOf;
using testing::HasSubstr;

/// Coordinates with all their bits, so that a lost one is seen.
Mesh box() {
  return testing_support::box_mesh({.cells = {2, 3, 2}, .upper = {1.0 / 3, 0.7, 1e-5}, .perturbation = 0.1});
}

void add_volume(CgnsFile& file, const Mesh& mesh) {
  file.add_zone(mesh);
  file.add_section("Volume", CGNS_ENUMV(TETRA_4), mesh.cells);
}

std::vector<cgsize_t> range(cgsize_t first, std::size_t count) {
  std::vector<cgsize_t> out(count);
  std::iota(out.begin(), out.end(), first);
  return out;
}

class Cgns : public testing::Test {
 protected:
  Mesh read(const std::string& path) {
    return read_cgns(path, [this](const std::string& note) { notes_.push_back(note); });
  }
  /// Expects the original in the CGNS file and, after writing, in the SU2 file.
  void expect_original(const std::string& path) {
    const Mesh mesh = read(path);
    mesh.validate();
    EXPECT_EQ(mesh.hash(), original_.hash());
    write_su2(folder_ / "mesh.su2", mesh);
    EXPECT_EQ(read_mesh(folder_ / "mesh.su2").hash(), original_.hash());
  }
  std::string error_of(const std::string& path) {
    try {
      read(path);
    } catch (const InputError& error) {
      EXPECT_EQ(error.problems().size(), 1u);
      EXPECT_EQ(error.problems().front().file, path);
      EXPECT_FALSE(error.problems().front().remedy.empty());
      return error.what();
    }
    ADD_FAILURE() << "nothing was wrong";
    return "";
  }
  /// The error that reading a file gives which `fill` has filled.
  std::string error_in(const std::function<void(CgnsFile&)>& fill) {
    const auto path = folder_ / "wrong.cgns";
    {
      CgnsFile file(path);
      fill(file);
    }
    return error_of(path);
  }
  /// A place for a sample that outlives the test.
  std::string sample(const std::string& name) const {
    std::filesystem::create_directories(ALPHADOT_SAMPLES);
    const std::string path = std::string(ALPHADOT_SAMPLES) + "/" + name;
    std::ofstream(path + ".hash") << original_.hash();
    return path;
  }

  Mesh original_ = box();
  TemporaryFolder folder_;
  std::vector<std::string> notes_;
};

TEST_F(Cgns, SectionsNameThePatches) {
  const auto path = sample("sections.cgns");
  {
    CgnsFile file(path);
    add_volume(file, original_);
    for (const auto& patch : original_.patches)
      file.add_section(patch.name, CGNS_ENUMV(TRI_3), patch.triangles);
  }
  expect_original(path);
  EXPECT_TRUE(notes_.empty());
}

TEST_F(Cgns, ConditionsAndTheirFamiliesNameThePatches) {
  const auto path = sample("families.cgns");
  {
    CgnsFile file(path);
    add_volume(file, original_);
    std::vector<std::array<GlobalIndex, 3>> all;
    for (const auto& patch : original_.patches)
      all.insert(all.end(), patch.triangles.begin(), patch.triangles.end());
    auto first = file.add_section("Surface", CGNS_ENUMV(TRI_3), all);
    // Lists and ranges, with a family and without.
    for (std::size_t i = 0; i < original_.patches.size(); ++i) {
      const auto& patch = original_.patches[i];
      const auto ids = range(first, patch.triangles.size());
      const bool has_family = i % 3 > 0;
      const std::string name = has_family ? "condition " + std::to_string(i) : patch.name;
      if (i % 2 == 0)
        file.add_condition(name, CGNS_ENUMV(PointList), ids, has_family ? patch.name : "");
      else
        file.add_condition(name, CGNS_ENUMV(PointRange), {ids.front(), ids.back()},
                           has_family ? patch.name : "");
      first += static_cast<cgsize_t>(ids.size());
    }
  }
  expect_original(path);
}

TEST_F(Cgns, MixedSections) {
  const auto path = sample("mixed.cgns");
  {
    CgnsFile file(path);
    file.add_zone(original_);
    const auto typed = [](auto type, const auto& elements) {
      std::vector<std::vector<cgsize_t>> out;
      for (const auto& element : elements) {
        auto& entry = out.emplace_back(std::vector{static_cast<cgsize_t>(type)});
        for (const auto point : element) entry.push_back(static_cast<cgsize_t>(point) + 1);
      }
      return out;
    };
    file.add_mixed_section("Volume", typed(CGNS_ENUMV(TETRA_4), original_.cells));
    for (const auto& patch : original_.patches) {
      auto elements = typed(CGNS_ENUMV(TRI_3), patch.triangles);
      elements.push_back({CGNS_ENUMV(BAR_2), 1, 2});  // lines are of no use
      file.add_mixed_section(patch.name, elements);
    }
  }
  expect_original(path);
}

TEST_F(Cgns, LinesAndConditionsOnVerticesArePassedOver) {
  const auto path = folder_ / "a.cgns";
  {
    CgnsFile file(path);
    add_volume(file, original_);
    for (const auto& patch : original_.patches)
      file.add_section(patch.name, CGNS_ENUMV(TRI_3), patch.triangles);
    file.add_section("edge", CGNS_ENUMV(BAR_2), std::vector<std::array<int, 2>>{{0, 1}, {1, 2}});
    file.add_condition("corner", CGNS_ENUMV(PointList), {1, 2, 3}, "", CGNS_ENUMV(Vertex));
  }
  expect_original(path);
  EXPECT_THAT(notes_,
              testing::ElementsAre(AllOf(HasSubstr("corner"), HasSubstr("Vertex"), HasSubstr("sections"))));
}

TEST_F(Cgns, StructuredAndSeveralZonesAreRefused) {
  EXPECT_THAT(
      error_in([](CgnsFile& file) {
        cgsize_t size[9] = {3, 3, 3, 2, 2, 2, 0, 0, 0};
        int zone = 0;
        test::check(cg_zone_write(file.id(), file.base(), "block", size, CGNS_ENUMV(Structured), &zone));
      }),
      AllOf(HasSubstr("zone block is Structured"), HasSubstr("unstructured zone")));
  EXPECT_THAT(error_in([this](CgnsFile& file) {
                file.add_zone(original_, "one");
                file.add_zone(original_, "two");
              }),
              HasSubstr("2 zones: one, two"));
  EXPECT_THAT(error_in([](CgnsFile&) {}), HasSubstr("no zone"));
}

TEST_F(Cgns, PolyhedraAreRefusedByName) {
  const auto refused = AllOf(HasSubstr("the mesh is of polyhedra, which are not read"), HasSubstr("HEXA_8"));
  for (const auto type : {CGNS_ENUMV(NGON_n), CGNS_ENUMV(NFACE_n)})
    EXPECT_THAT(error_in([&](CgnsFile& file) {
                  add_volume(file, original_);
                  const std::vector<cgsize_t> entries{1, 2, 3, 4}, offsets{0, 4};
                  const auto last = static_cast<cgsize_t>(original_.cells.size() + 1);
                  int section = 0;
                  test::check(cg_poly_section_write(file.id(), file.base(), file.zone(), "faces", type, last,
                                                    last, 0, entries.data(), offsets.data(), &section));
                }),
                AllOf(HasSubstr("section faces holds " + std::string(cg_ElementTypeName(type))), refused));
}

TEST_F(Cgns, MeshesWithoutAVolumeAreRefused) {
  EXPECT_THAT(error_in([this](CgnsFile& file) { file.add_zone(original_); }),
              HasSubstr("no volume elements"));
  EXPECT_THAT(error_in([this](CgnsFile& file) {
                file.add_zone(original_);
                file.add_section("skin", CGNS_ENUMV(TRI_3), original_.patches.front().triangles);
              }),
              HasSubstr("it is the surface of a body"));
}

TEST_F(Cgns, WrongPointsAndConditionsAreNamed) {
  EXPECT_THAT(error_in([this](CgnsFile& file) {
                auto mesh = original_;
                mesh.cells[3][2] = std::ssize(mesh.points);
                add_volume(file, mesh);
              }),
              HasSubstr("element 4 in section Volume uses point 37 of 36"));
  EXPECT_THAT(error_in([this](CgnsFile& file) {
                add_volume(file, original_);
                file.add_condition("wall", CGNS_ENUMV(PointList), {7});
              }),
              HasSubstr("boundary condition wall lists element 7, which is no face"));
  EXPECT_THAT(error_in([this](CgnsFile& file) {
                add_volume(file, original_);
                const auto first =
                    file.add_section("Surface", CGNS_ENUMV(TRI_3), original_.patches.front().triangles);
                file.add_condition("wall", CGNS_ENUMV(PointList), {first, first + 1});
                file.add_condition("base", CGNS_ENUMV(PointList), {first + 1});
              }),
              AllOf(HasSubstr("two boundary conditions, wall and base"), HasSubstr("give every face one")));
  EXPECT_THAT(
      error_in([this](CgnsFile& file) {
        add_volume(file, original_);
        const std::vector<cgsize_t> points{1, 2, 3};
        const auto last = static_cast<cgsize_t>(original_.cells.size());
        int section = 0;
        test::check(cg_section_write(file.id(), file.base(), file.zone(), "lid", CGNS_ENUMV(TRI_3), last,
                                     last, 0, points.data(), &section));
      }),
      HasSubstr("sections Volume and lid both have an element " + std::to_string(original_.cells.size())));
  EXPECT_THAT(error_in([this](CgnsFile& file) { file.add_zone(original_, "Zone", "Radius"); }),
              HasSubstr("RadiusX, RadiusY, RadiusZ"));
}

TEST_F(Cgns, FilesThatAreNoneAreRefused) {
  EXPECT_THAT(error_of(folder_ / "none.cgns"), HasSubstr("cannot read the file"));
  std::ofstream(folder_ / "text.cgns") << "NDIME= 3\n";
  EXPECT_THAT(error_of(folder_ / "text.cgns"), HasSubstr("this is no CGNS file"));
}

TEST_F(Cgns, NamesThatSu2CannotHaveAreChanged) {
  original_.patches[0].name = "upper wall";
  original_.patches[1].name = "50%=x";
  write_su2(folder_ / "mesh.su2", original_);
  const auto mesh = read_mesh(folder_ / "mesh.su2");
  EXPECT_EQ(mesh.patches[0].name, "upper_wall");
  EXPECT_EQ(mesh.patches[1].name, "50__x");
  original_.patches[1].name = "upper_wall";
  EXPECT_THROW(write_su2(folder_ / "mesh.su2", original_), InputError);
}

}  // namespace
}  // namespace alphadot
