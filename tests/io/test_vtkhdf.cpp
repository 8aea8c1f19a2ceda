// Expectations: the VTKHDF 1.0 format as ParaView 5.11 reads it, the volume of the box and the areas of its
// sides. The files are left in the build tree, where check_vtkhdf.py looks at them with another HDF5 library.
#include "io/vtkhdf.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "core/error.hpp"
#include "io/files.hpp"
#include "io/hdf5.hpp"
#include "io/temporary_folder.hpp"
#include "support/box_mesh.hpp"

namespace alphadot {
namespace {

const testing_support::BoxSettings box{
    .cells = {3, 4, 5}, .lower = {-1, 0, 0}, .upper = {2, 1, 0.5}, .perturbation = 0.1};
const Origin origin{{.mach = 2.5, .alpha = 1.5, .beta = -3}, "/a/box.msh", "0123456789abcdef", "0.1.0"};
constexpr Real volume = 3 * 1 * 0.5;

Subdomain distributed_box(const Communicator& comm) {
  return distribute(comm.is_root() ? testing_support::box_mesh(box) : Mesh{}, comm);
}

std::string sample(const std::string& name, const Communicator& comm) {
  return std::string(ALPHADOT_SAMPLES) + "/" + name + "_" + std::to_string(comm.size()) + ".vtkhdf";
}

/// The datasets of a file, read on the root.
struct Grid {
  std::vector<float> points;
  std::vector<std::int64_t> connectivity, offsets;
  std::vector<std::uint8_t> types;

  explicit Grid(const hdf5::Group& root)
      : points(root.dataset("Points").read<float>()),
        connectivity(root.dataset("Connectivity").read<std::int64_t>()),
        offsets(root.dataset("Offsets").read<std::int64_t>()),
        types(root.dataset("Types").read<std::uint8_t>()) {}

  Vec3 point(std::size_t cell, std::size_t corner) const {
    const auto at =
        3 * static_cast<std::size_t>(connectivity[static_cast<std::size_t>(offsets[cell]) + corner]);
    return {points[at], points[at + 1], points[at + 2]};
  }
};

TEST(VtkHdf, FlowHoldsEveryCellOnce) {
  const Communicator comm;
  const Subdomain domain = distributed_box(comm);
  // The centre of a cell as a vector and its x as a scalar: values that the file's own geometry can confirm.
  std::vector<Real> x(static_cast<std::size_t>(domain.total_cells));
  for (std::size_t i = 0; i < x.size(); ++i) x[i] = domain.center[i].x;
  comm.on_root([] { std::filesystem::create_directories(ALPHADOT_SAMPLES); });
  write_flow(sample("flow", comm), domain, {{"x", x}, {"center", domain.center}}, origin, comm);

  comm.on_root([&] {
    const auto file = hdf5::File::open(sample("flow", comm));
    const auto root = file.group("VTKHDF");
    const Grid grid(root);
    const auto about = root.group("FieldData");
    EXPECT_EQ(about.text_attribute("origin"),
              "Mach 2.5, alpha 1.5 deg, beta -3 deg, gamma 1.4; mesh box.msh, hash 0123456789abcdef; "
              "alphadot 0.1.0");
    EXPECT_EQ(about.dataset("mach").read<double>(), std::vector<double>{2.5});
    EXPECT_EQ(about.dataset("beta").read<double>(), std::vector<double>{-3});
    const std::size_t cells = 6 * 3 * 4 * 5;
    ASSERT_EQ(grid.types, std::vector<std::uint8_t>(cells, 10));
    ASSERT_EQ(grid.offsets.size(), cells + 1);
    const auto xs = root.dataset("CellData/x").read<double>();
    const auto centers = root.dataset("CellData/center").read<double>();
    ASSERT_EQ(centers.size(), 3 * cells);
    Real sum = 0;
    for (std::size_t cell = 0; cell < cells; ++cell) {
      const Vec3 a = grid.point(cell, 0), b = grid.point(cell, 1), c = grid.point(cell, 2),
                 d = grid.point(cell, 3);
      const Real v = dot(cross(b - a, c - a), d - a) / 6;
      EXPECT_GT(v, 0);
      sum += v;
      const Vec3 center = 0.25 * (a + b + c + d);
      EXPECT_NEAR(xs[cell], center.x, 1e-6);
      EXPECT_NEAR(centers[3 * cell + 2], center.z, 1e-6);
    }
    EXPECT_NEAR(sum, volume, 1e-5);  // points are 32-bit floats
  });
}

TEST(VtkHdf, SurfaceHoldsEveryFaceWithItsPatch) {
  const Communicator comm;
  const Subdomain domain = distributed_box(comm);
  std::vector<Real> z(domain.boundary_faces.size());
  for (std::size_t i = 0; i < z.size(); ++i) z[i] = domain.boundary_center[i].z;
  comm.on_root([] { std::filesystem::create_directories(ALPHADOT_SAMPLES); });
  write_surface(sample("surface", comm), domain, {{"z", z}, {"normal", domain.boundary_normal}}, origin,
                comm);

  comm.on_root([&] {
    const auto file = hdf5::File::open(sample("surface", comm));
    const auto root = file.group("VTKHDF");
    const Grid grid(root);
    const auto zs = root.dataset("CellData/z").read<double>();
    const auto patch = root.dataset("CellData/patch").read<std::int32_t>();
    ASSERT_EQ(root.dataset("CellData/patch").text_attribute("names"),
              "x_min\nx_max\ny_min\ny_max\nz_min\nz_max\n");
    const std::size_t faces = 4 * (3 * 4 + 4 * 5 + 5 * 3);  // two triangles on each square of six sides
    ASSERT_EQ(grid.types, std::vector<std::uint8_t>(faces, 5));
    std::vector<Real> area(6, 0);
    for (std::size_t face = 0; face < faces; ++face) {
      const Vec3 a = grid.point(face, 0), b = grid.point(face, 1), c = grid.point(face, 2);
      area[static_cast<std::size_t>(patch[face])] += norm(cross(b - a, c - a)) / 2;
      EXPECT_NEAR(zs[face], (a.z + b.z + c.z) / 3, 1e-6);
    }
    const Real expected[] = {0.5, 0.5, 1.5, 1.5, 3, 3};
    for (std::size_t i = 0; i < 6; ++i) EXPECT_NEAR(area[i], expected[i], 1e-5) << i;
  });
}

// Values at points are looked at by check_vtkhdf.py.
TEST(VtkHdf, SurfaceOfSomePatches) {
  const Communicator comm;
  const Subdomain domain = distributed_box(comm);
  std::vector<Real> x(domain.boundary_faces.size());
  for (std::size_t i = 0; i < x.size(); ++i) x[i] = domain.boundary_center[i].x;
  const TemporaryFolder folder;
  const std::string path = comm.broadcast(folder / "some.vtkhdf");
  const std::vector<std::size_t> sides{0, 1};
  write_surface(path, domain, {{"x", x}}, origin, comm, sides);
  comm.on_root([&] {
    const auto file = hdf5::File::open(path);
    const auto root = file.group("VTKHDF");
    EXPECT_EQ(root.dataset("CellData/patch").read<std::int32_t>().size(), 2u * 2 * 4 * 5);
    for (const Real at : root.dataset("PointData/x").read<double>())  // of both ends, where all faces have it
      EXPECT_TRUE(std::abs(at + 1) < 1e-6 || std::abs(at - 2) < 1e-6) << at;
  });
}

TEST(VtkHdf, FailureReachesEveryRankAndLeavesNoFile) {
  const Communicator comm;
  const Subdomain domain = distributed_box(comm);
  EXPECT_THROW(write_flow("/proc/none/flow.vtkhdf", domain, {}, origin, comm), InputError);
  const TemporaryFolder folder;
  const std::string path = comm.broadcast(folder / "flow.vtkhdf");
  const std::vector<Real> wrong(1);
  EXPECT_THROW(write_flow(path, domain, {{"p", wrong}}, origin, comm), std::logic_error);
  comm.on_root([&] { EXPECT_TRUE(std::filesystem::is_empty(folder.path())); });
}

}  // namespace
}  // namespace alphadot
