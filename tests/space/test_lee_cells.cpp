// Cells behind walls that face aft: a cube in a box, behind which they are counted by their places.
#include "space/lee_cells.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "support/cube_mesh.hpp"

namespace alphadot {
namespace {

constexpr Real half = 0.5, back = 2;  // of the cube from (1, -1/2, -1/2) to (2, 1/2, 1/2)

Mesh cube() {
  return testing_support::around_a_cube({.cells = {12, 8, 8}, .lower = {-1, -2, -2}, .upper = {5, 2, 2}},
                                        {1, -half, -half}, {back, half, half});
}

std::vector<std::uint8_t> marks_of(const Subdomain& domain, BoundaryKind kind, const Communicator& comm) {
  std::vector<BoundaryKind> kinds(7, BoundaryKind::farfield);
  kinds.back() = kind;
  return lee_cells(Discretization(domain, kinds, {}, 1.4), comm);
}

// On every rank, ghosts included: what has a corner on the back of the cube and lies behind it.
TEST(LeeCells, AreThoseBehindTheBack) {
  const Communicator comm;
  const Subdomain domain = distribute(cube(), comm);
  const auto is_on_back = [&](Index point) {
    const Vec3 x = domain.points[point];
    return std::abs(x.x - back) < 1e-9 && std::abs(x.y) < half + 1e-9 && std::abs(x.z) < half + 1e-9;
  };
  for (const auto kind : {BoundaryKind::wall, BoundaryKind::sting}) {
    const auto marks = marks_of(domain, kind, comm);
    ASSERT_EQ(marks.size(), domain.center.size());
    GlobalIndex marked = 0;
    for (Index cell = 0; cell < domain.total_cells; ++cell) {
      bool expected = false;
      for (const Index point : domain.cell_points[cell])
        expected |= is_on_back(point) && domain.center[cell].x > back;
      EXPECT_EQ(marks[static_cast<std::size_t>(cell)], expected ? 1 : 0);
      if (expected && cell < domain.owned_cells) ++marked;
    }
    EXPECT_GT(comm.sum(marked), 0);
  }
}

TEST(LeeCells, NoneBehindAJet) {
  const Communicator comm;
  const Subdomain domain = distribute(cube(), comm);
  const auto marks = marks_of(domain, BoundaryKind::jet, comm);
  EXPECT_EQ(std::count(marks.begin(), marks.end(), 1), 0);
}

}  // namespace
}  // namespace alphadot
