// What a mesh is as a configuration, and what is said about it. Expectations: a cube of side 1 in a box,
// whose areas and distances are known, put beside cases that are wrong in one known way.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "derivatives/case.hpp"
#include "space/plausibility.hpp"
#include "support/cube_mesh.hpp"

namespace alphadot {
namespace {

using testing_support::around_a_cube;

using Kinds = std::vector<BoundaryKind>;  // of x_min, x_max, y_min, y_max, z_min, z_max, body
constexpr auto wall = BoundaryKind::wall, far_field = BoundaryKind::farfield, plane = BoundaryKind::symmetry;

/// A cube from (1, -1/2, -1/2) to (2, 1/2, 1/2) in the box from (-1, -2, -2) to (5, 2, 2).
Mesh whole_cube() {
  return around_a_cube({.cells = {12, 8, 8}, .lower = {-1, -2, -2}, .upper = {5, 2, 2}}, {1, -0.5, -0.5},
                       {2, 0.5, 0.5});
}
/// Its half y >= 0.
Mesh half_cube() {
  return around_a_cube({.cells = {12, 4, 8}, .lower = {-1, 0, -2}, .upper = {5, 2, 2}}, {1, -0.5, -0.5},
                       {2, 0.5, 0.5});
}
const Kinds whole_kinds{far_field, far_field, far_field, far_field, far_field, far_field, wall};
const Kinds half_kinds{far_field, far_field, plane, far_field, far_field, far_field, wall};

Case case_of(bool half_model, Real mach = 2) {
  Case out;
  out.file = "cube.toml";
  out.reference.half_model = half_model;
  out.reference.moment_center = {1.5, 0, 0};
  out.freestream.mach = mach;
  return out;
}

void transform(Mesh& mesh, const std::function<Vec3(const Vec3&)>& to) {
  for (auto& point : mesh.points) point = to(point);
}
/// Turned about the x axis: y becomes z.
Vec3 turned(const Vec3& p) {
  return {p.x, -p.z, p.y};
}

struct Look {
  Configuration facts;
  Findings findings;
};

Look look(const Mesh& mesh, const Kinds& kinds, const Case& settings) {
  const Communicator comm;
  mesh.validate();
  const auto domain = distribute(mesh, comm, settings.mesh.scale);
  Look out;
  out.facts = survey(domain, kinds, settings, comm);
  out.findings = judge(out.facts, domain.patch_names, kinds, settings, settings.mesh.scale, settings.file);
  return out;
}

/// One problem, which says all of `parts`.
void expect_problem(const Look& look, const std::vector<std::string>& parts) {
  ASSERT_EQ(look.findings.problems.size(), 1u) << look.findings.problems.back().text();
  for (const auto& part : parts)
    EXPECT_NE(look.findings.problems[0].text().find(part), std::string::npos)
        << look.findings.problems[0].text();
}

/// One warning, which says all of `parts`, and no problem.
void expect_warning(const Look& look, const std::vector<std::string>& parts) {
  for (const auto& problem : look.findings.problems) ADD_FAILURE() << problem.text();
  ASSERT_EQ(look.findings.warnings.size(), 1u) << look.findings.warnings.back();
  for (const auto& part : parts)
    EXPECT_NE(look.findings.warnings[0].find(part), std::string::npos) << look.findings.warnings[0];
}

void expect_near(const Vec3& a, const Vec3& b) {
  for (int d = 0; d < 3; ++d) EXPECT_NEAR(a[d], b[d], 1e-12);
}

TEST(Configuration, KnowsTheSizeOfACube) {
  for (const bool half : {false, true}) {
    auto settings = case_of(half);
    settings.reference.length = 0.5;
    settings.reference.area = 0.1;
    const auto facts = half ? look(half_cube(), half_kinds, settings).facts
                            : look(whole_cube(), whole_kinds, settings).facts;
    expect_near(facts.body.lower, {2, -1, -1});
    expect_near(facts.body.upper, {4, 1, 1});
    EXPECT_NEAR(facts.body_length, 2, 1e-12);
    EXPECT_NEAR(facts.wall_area, 60, 1e-11);
    expect_near(facts.projected_area, {10, 10, 10});
    expect_near(facts.net_area, {0, 0, 0});
    EXPECT_NEAR(facts.aft_area[6], 10, 1e-12);
    EXPECT_NEAR(facts.far_field_distance, 2 * 1.5, 1e-12);  // to the sides
    EXPECT_NEAR(facts.surface_asymmetry, 0, 1e-14);
    EXPECT_NEAR(facts.cell_asymmetry, 0, 1e-14);
    EXPECT_EQ(facts.region_count, 1);
    EXPECT_FALSE(facts.is_section);
  }
}

TEST(Configuration, IsTheSameInAnyUnitOfLength) {
  const auto metres = look(whole_cube(), whole_kinds, case_of(false)).facts;
  auto settings = case_of(false);
  settings.mesh.scale = 0.0254;
  settings.reference = {0.0254, 0.0254 * 0.0254, {0.0254 * 1.5, 0, 0}, false};
  const auto inches = look(whole_cube(), whole_kinds, settings).facts;
  const auto expect_close = [](Real a, Real b) { EXPECT_NEAR(a, b, 1e-12 * std::abs(b) + 1e-13); };
  for (int d = 0; d < 3; ++d) {
    expect_close(inches.body.lower[d], metres.body.lower[d]);
    expect_close(inches.domain.upper[d], metres.domain.upper[d]);
    expect_close(inches.projected_area[d], metres.projected_area[d]);
  }
  expect_close(inches.wall_area, metres.wall_area);
  expect_close(inches.far_field_ratio, metres.far_field_ratio);
  expect_close(inches.quality.smallest_angle.value, metres.quality.smallest_angle.value);
}

TEST(Configuration, SeesWhatIsNoMirrorImage) {
  auto mesh = whole_cube();
  transform(mesh, [](const Vec3& p) { return Vec3{p.x, p.y, p.z > 0 ? 1.2 * p.z : p.z}; });
  // Area times height: the lid at 0.6 against the floor at 0.5, and four sides of areas 0.6 and 0.5 with
  // their middles at 0.3 and 0.25.
  const Real upper = 0.6 + 4 * 0.6 * 0.3, lower = 0.5 + 4 * 0.5 * 0.25;
  const auto facts = look(mesh, whole_kinds, case_of(false)).facts;
  EXPECT_NEAR(facts.surface_asymmetry, (upper - lower) / (upper + lower), 1e-12);
  EXPECT_GT(facts.cell_asymmetry, 0.05);
}

TEST(Configuration, KnowsWhetherMachWavesComeBack) {
  // From the edges of the cube's front, x = 1, to the sides 1.5 away and back again: the foremost wave
  // arrives 3 sqrt(M^2 - 1) lengths behind the nose, but for the distance of the first face's centre from the
  // wave.
  const Real spacing = 0.5;
  for (const Real mach : {1.05, 1.2, 1.5}) {
    const Real arrival = 3 * std::sqrt(mach * mach - 1);
    const auto facts = look(whole_cube(), whole_kinds, case_of(false, mach)).facts;
    EXPECT_GT(facts.far_field_ratio, arrival - 1e-9);
    EXPECT_LT(facts.far_field_ratio, arrival + spacing);
  }
  EXPECT_GT(look(whole_cube(), whole_kinds, case_of(false, 4)).facts.far_field_ratio, 3);
}

TEST(Configuration, ComparesASubsonicFarFieldWithWhatItNeeds) {
  const auto facts = look(whole_cube(), whole_kinds, case_of(false, 0.6)).facts;
  EXPECT_NEAR(facts.far_field_ratio, 1.5 / (10 / 0.8), 1e-12);
  EXPECT_NEAR(needed_far_field_distance(0.6, true), 125, 1e-12);
}

TEST(Plausibility, HasNothingToSayAboutASoundCase) {
  for (const bool half : {false, true}) {
    const auto seen = half ? look(half_cube(), half_kinds, case_of(true, 1.15))
                           : look(whole_cube(), whole_kinds, case_of(false, 1.15));
    EXPECT_TRUE(seen.findings.problems.empty());
    EXPECT_TRUE(seen.findings.warnings.empty());
  }
}

TEST(Plausibility, WarnsOfABluntBaseInSupersonicFlowOnly) {
  expect_warning(look(whole_cube(), whole_kinds, case_of(false)),
                 {"1 reference areas of the wall \"body\" face aft, 100 %", "\"jet\"", "\"sting\""});
  for (const auto& warning : look(whole_cube(), whole_kinds, case_of(false, 1.1)).findings.warnings)
    EXPECT_EQ(warning.find("face aft"), std::string::npos);
}

TEST(Plausibility, RefusesRegionsOfTheirOwn) {
  // The tool that cut the cube is left in the mesh, with points of its own.
  Mesh mesh = whole_cube();
  const Mesh tool =
      testing_support::box_mesh({.cells = {2, 2, 2}, .lower = {1, -0.5, -0.5}, .upper = {2, 0.5, 0.5}});
  const auto first = static_cast<GlobalIndex>(mesh.points.size());
  mesh.points.insert(mesh.points.end(), tool.points.begin(), tool.points.end());
  for (auto cell : tool.cells) {
    for (auto& point : cell) point += first;
    mesh.cells.push_back(cell);
  }
  for (const auto& patch : tool.patches)
    for (auto triangle : patch.triangles) {
      for (auto& point : triangle) point += first;
      mesh.patches.back().triangles.push_back(triangle);
    }
  expect_problem(
      look(mesh, whole_kinds, case_of(false)),
      {"2 regions", "4560 cells from (-1, -2, -2) to (5, 2, 2)",
       "48 cells from (1, -0.5, -0.5) to (2, 0.5, 0.5) inside \"body\" without a far field", "delete"});
}

TEST(Plausibility, RefusesAFlowWithoutAFarField) {
  Kinds closed(7, wall);
  closed[2] = plane;
  expect_problem(look(half_cube(), closed, case_of(true)), {"no patch is a \"farfield\""});
}

TEST(Plausibility, RefusesAHalfMeshAsAFullModel) {
  expect_problem(
      look(half_cube(), half_kinds, case_of(false)),
      {"reference.model is \"full\"", "\"y_min\" in the plane y = 0", "set reference.model = \"half\""});
}

TEST(Plausibility, RefusesAFullMeshAsAHalfModel) {
  expect_problem(look(whole_cube(), whole_kinds, case_of(true)),
                 {"no symmetry patch lies in the plane y = 0", "set reference.model = \"full\""});
}

TEST(Plausibility, RefusesAHalfModelCutElsewhere) {
  Mesh aside = half_cube(), port = half_cube(), lying = half_cube();
  transform(aside, [](const Vec3& p) { return p + Vec3{0, 0.25, 0}; });
  expect_problem(look(aside, half_kinds, case_of(true)),
                 {"there is \"y_min\" in the plane y = 0.25", "move the mesh along y"});
  // Turned by half a turn: the half y <= 0.
  transform(port, [](const Vec3& p) { return turned(turned(p)); });
  expect_problem(look(port, half_kinds, case_of(true)), {"the half y <= 0", "mirror"});
  transform(lying, turned);
  expect_problem(look(lying, half_kinds, case_of(true)),
                 {"there is \"y_min\" in the plane z = 0", "turn the mesh about the x axis"});
  expect_problem(look(lying, half_kinds, case_of(false)), {"the plane z = 0", "turn or move the mesh"});
}

TEST(Plausibility, RefusesAMeshThatGoesOnBeyondTheMiddle) {
  // A step: behind x = 2 the mesh reaches down to y = -1. Its face in the plane y = 0 is a symmetry patch.
  Mesh mesh = around_a_cube({.cells = {12, 6, 8}, .lower = {-1, -1, -2}, .upper = {5, 2, 2}}, {-2, -2, -3},
                            {2, 0, 3});
  Patch middle{"middle", {}};
  std::erase_if(mesh.patches.back().triangles, [&](const auto& triangle) {
    const bool is_in_middle = std::ranges::all_of(
        triangle, [&](GlobalIndex point) { return std::abs(mesh.points[point].y) < 1e-12; });
    if (is_in_middle) middle.triangles.push_back(triangle);
    return is_in_middle;
  });
  mesh.patches.push_back(middle);
  Kinds kinds = whole_kinds;
  kinds.push_back(plane);
  expect_problem(look(mesh, kinds, case_of(true)), {"goes on beyond the plane y = 0, to y = -1"});
}

TEST(Plausibility, RefusesAQuarterOfABody) {
  const Mesh quarter = around_a_cube({.cells = {12, 4, 4}, .lower = {-1, 0, 0}, .upper = {5, 2, 2}},
                                     {1, -0.5, -0.5}, {2, 0.5, 0.5});
  Kinds kinds = half_kinds;
  kinds[4] = plane;
  expect_problem(look(quarter, kinds, case_of(true)), {"\"z_min\" in the plane z = 0", "whole half"});
}

TEST(Plausibility, AcceptsSectionsAndTunnels) {
  // A prism from one symmetry plane to another is two-dimensional flow, as half and as full model; planes
  // that do not cut the body are the walls of a tunnel.
  const Mesh slab = around_a_cube({.cells = {12, 1, 8}, .lower = {-1, 0, -2}, .upper = {5, 0.5, 2}},
                                  {1, -1, -0.5}, {2, 1, 0.5});
  Kinds kinds = half_kinds;
  kinds[3] = plane;
  for (const bool half : {false, true}) {
    const auto seen = look(slab, kinds, case_of(half));
    EXPECT_TRUE(seen.facts.is_section);
    EXPECT_TRUE(seen.findings.problems.empty());
  }
  kinds[4] = kinds[5] = plane;
  EXPECT_TRUE(look(half_cube(), kinds, case_of(true)).findings.problems.empty());
}

// Of a slab of width 0.5 and chord 1 the planform is 0.5; counted as a half, 1.
TEST(Plausibility, WarnsOfASectionsArea) {
  const Mesh slab = around_a_cube({.cells = {12, 1, 8}, .lower = {-1, 0, -2}, .upper = {5, 0.5, 2}},
                                  {1, -1, -0.5}, {2, 1, 0.5});
  Kinds kinds = half_kinds;
  kinds[3] = plane;
  const auto warned = [&](bool half, Real area) {
    auto settings = case_of(half);
    settings.reference.area = area;
    const auto seen = look(slab, kinds, settings);
    return std::ranges::any_of(seen.findings.warnings, [](const std::string& text) {
      return text.find("times the planform of the section") != std::string::npos;
    });
  };
  EXPECT_FALSE(warned(true, 1));
  EXPECT_FALSE(warned(false, 0.5));
  EXPECT_TRUE(warned(false, 1));
  EXPECT_TRUE(warned(true, 0.5));
}

TEST(Plausibility, RefusesASymmetryPatchThatIsNotPlane) {
  Mesh mesh = half_cube();
  transform(mesh, [](const Vec3& p) {
    return p.y == 0 ? Vec3{p.x, -0.02 * (1 + std::sin(3 * p.x + 2 * p.z)), p.z} : p;
  });
  const auto seen = look(mesh, half_kinds, case_of(true));
  ASSERT_FALSE(seen.findings.problems.empty());
  EXPECT_NE(seen.findings.problems[0].text().find("the symmetry patch \"y_min\" is not plane"),
            std::string::npos);
}

TEST(Plausibility, WarnsOfWrongUnits) {
  Kinds kinds = whole_kinds;
  const auto with = [&](const std::function<void(Case&)>& change) {
    auto settings = case_of(false, 1.1);  // no word about the base
    change(settings);
    auto seen = look(whole_cube(), kinds, settings);
    std::erase_if(seen.findings.warnings,
                  [](const std::string& text) { return text.find("far field") != std::string::npos; });
    return seen;
  };
  EXPECT_TRUE(with([](Case&) {}).findings.warnings.empty());
  expect_warning(with([](Case& c) {
                   c.reference.length = 1e-3;
                   c.reference.area = 1;
                 }),
                 {"1000 reference lengths long", "mesh.scale = 1"});
  expect_warning(with([](Case& c) { c.reference.length = 1e3; }), {"0.001 reference lengths long"});
  expect_warning(with([](Case& c) { c.reference.area = 1e6; }), {"reference.area is 1e+06 times"});
  expect_warning(with([](Case& c) { c.reference.area = 1e-6; }), {"reference.area is 1e-06 times"});
  expect_warning(with([](Case& c) {
                   c.reference.moment_center = {150, 0, 0};
                 }),
                 {"moment_center is 148 body lengths away"});
}

TEST(Plausibility, WarnsOfANearFarField) {
  const auto of = [](Real mach) { return look(whole_cube(), whole_kinds, case_of(false, mach)); };
  expect_warning(of(1.02), {"far field is too near", "Mach cone of 78.64 degrees"});
  expect_warning(of(0.6), {"1.5 body lengths from the body, where Mach 0.6 needs 12.5"});
}

TEST(Plausibility, WarnsOfBadCells) {
  Mesh mesh = whole_cube();
  transform(mesh, [](const Vec3& p) { return Vec3{p.x == 4.5 ? 4.0005 : p.x, p.y, p.z}; });
  const auto seen = look(mesh, whole_kinds, case_of(false, 1.1));
  const auto says = [&](const std::string& part) {
    return std::ranges::any_of(seen.findings.warnings,
                               [&](const std::string& text) { return text.find(part) != std::string::npos; });
  };
  EXPECT_TRUE(says("at 0.0573 degrees"));  // atan(0.0005 / 0.5)
  EXPECT_TRUE(says("has an aspect ratio of"));
  EXPECT_TRUE(says("has a neighbour 2e+03 times as large"));  // 0.9995 / 0.0005 = 1999
}

TEST(Plausibility, RefusesACaseWithoutWalls) {
  Kinds kinds = whole_kinds;
  kinds[6] = far_field;
  expect_problem(look(whole_cube(), kinds, case_of(false)), {"no patch is a \"wall\"", "all loads are zero"});
}

TEST(Plausibility, LooksAtSidesThatMayBePlanesOfSymmetry) {
  const auto seen = [&](BoundaryKind kind, const Mesh& mesh = half_cube(), std::size_t side = 2) {
    Kinds kinds(7, far_field);
    kinds[6] = wall;
    kinds[side] = kind;
    return look(mesh, kinds, case_of(false, 1.1));
  };
  const auto warns = [](const Look& look) {
    return std::ranges::any_of(look.findings.warnings, [](const std::string& text) {
      return text.find("\"y_min\" in the plane y = 0, a side of the mesh") != std::string::npos;
    });
  };
  expect_problem(seen(BoundaryKind::jet),
                 {"\"y_min\" in the plane y = 0", "other half are missing", "\"symmetry\""});
  for (const auto kind : {BoundaryKind::sting, wall, far_field}) {
    EXPECT_TRUE(warns(seen(kind)));
    EXPECT_TRUE(seen(kind).findings.problems.empty());
  }
  auto upright = half_cube();
  transform(upright, turned);
  expect_problem(seen(BoundaryKind::jet, upright), {"\"y_min\" in the plane z = 0"});
  EXPECT_FALSE(warns(seen(wall, whole_cube())));  // no body ends in this wall of a tunnel
  EXPECT_TRUE(seen(BoundaryKind::jet, whole_cube(), 1).findings.problems.empty());
}

// A fin of 1 % half thickness before a body, both cut by the plane of symmetry, in a far field of 2,000
// chords.
TEST(Plausibility, AThinFinInThePlaneOfSymmetryIsNoSideOfTheMesh) {
  Mesh mesh = half_cube();
  const auto faces = std::move(mesh.patches.back().triangles);
  mesh.patches.back().triangles.clear();
  mesh.patches.push_back({"body", {}});
  for (const auto& face : faces) {
    const auto x = [&](std::size_t corner) { return mesh.points[static_cast<std::size_t>(face[corner])].x; };
    mesh.patches[x(0) + x(1) + x(2) > 4.6 ? 7 : 6].triangles.push_back(face);
  }
  transform(mesh, [](const Vec3& p) {
    const auto far = [](Real at, Real from, Real to) {
      return at + 1000 * (std::min(at - from, 0.0) + std::max(at - to, 0.0));
    };
    const Real near = (p.x < 1.75 ? 0.02 : 1) * p.y;
    return Vec3{far(p.x, 0, 4), p.y < 0.6 ? near : 700 * (p.y - 0.6), far(p.z, -1, 1)};
  });
  Kinds kinds = half_kinds;
  kinds.push_back(wall);
  const auto seen = look(mesh, kinds, case_of(true, 0.5));
  EXPECT_TRUE(seen.facts.open_sides.empty());
  EXPECT_TRUE(seen.findings.problems.empty());
}

TEST(Plausibility, WarnsOfAJetThatLooksAhead) {
  Kinds kinds = whole_kinds;
  kinds[0] = wall;
  kinds[6] = BoundaryKind::jet;  // of a cube, one face of six looks ahead
  EXPECT_NE(look(whole_cube(), kinds, case_of(false, 0.3))
                .findings.warnings.back()
                .find("16.7 % of the jet \"body\" looks ahead"),
            std::string::npos);
}

TEST(Plausibility, WarnsOfMotionsThatNoVehicleDoes) {
  const auto with = [](MotionKind kind, Real amplitude, Real frequency, const Vec3& axis) {
    auto settings = case_of(false, 1.15);
    settings.motion.kind = kind;
    settings.motion.amplitude = amplitude;
    settings.motion.reduced_frequency = frequency;
    settings.motion.axis_point = axis;
    return look(whole_cube(), whole_kinds, settings);
  };
  expect_warning(with(MotionKind::pitch, 1, 0.01, {1e5, 0, 0}),
                 {"motion.axis_point is 1e+05 body lengths away"});
  auto turning = case_of(false, 1.15);
  turning.motion.rotation = {0, 0.01, 0};
  turning.motion.axis_point = {1e5, 0, 0};
  expect_warning(look(whole_cube(), whole_kinds, turning), {"motion.axis_point is 1e+05 body lengths away"});
  expect_warning(with(MotionKind::plunge, 180, 0.01, {}), {"motion.amplitude = 180 degrees"});
  // In a period of 2 pi / omega the stream passes pi / k lengths.
  expect_warning(with(MotionKind::plunge, 1, 100, {}),
                 {"in one period the stream passes 0.0314 of the body's length"});
  EXPECT_TRUE(with(MotionKind::plunge, 1, 0.01, {1e5, 0, 0}).findings.warnings.empty());
  EXPECT_TRUE(with(MotionKind::step_q, 20, 100, {1.5, 0, 0}).findings.warnings.empty());
}

}  // namespace
}  // namespace alphadot
