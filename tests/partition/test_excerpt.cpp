// Excerpts of a subdomain. Expected are the definition of rings, on the whole mesh, and what the cells and
// faces of an excerpt are in the subdomain that it is of.
#include "partition/excerpt.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "parallel.hpp"
#include "partition/halo.hpp"

namespace alphadot {
namespace {

using testing_support::random_owners;
using testing_support::test_box;

class ExcerptTest : public testing::TestWithParam<bool> {
 protected:
  static constexpr int most = 2;
  static constexpr GlobalIndex middle = 100;  // the cell that is marked

  const Communicator comm;
  const Mesh mesh = test_box();
  const Subdomain domain =
      GetParam() ? distribute(mesh, random_owners(mesh, comm.size()), comm) : distribute(mesh, comm);

  std::vector<std::uint8_t> rings() const {
    std::vector<std::uint8_t> marked;
    for (Index cell = 0; cell < domain.owned_cells; ++cell)
      marked.push_back(domain.cell_ids[static_cast<std::size_t>(cell)] == middle);
    return rings_around(domain, marked, most, comm);
  }
  /// And one cell of every rank.
  Excerpt excerpt() const {
    std::vector<Index> kept(static_cast<std::size_t>(domain.total_cells));
    const auto ring = rings();
    std::ranges::transform(ring, kept.begin(), [](auto r) { return r <= most ? 1 : 0; });
    kept[0] = 1;
    HaloExchange<Index>(domain, comm, kept).exchange();
    return excerpt_of(domain, std::vector<std::uint8_t>(kept.begin(), kept.end()));
  }
};
INSTANTIATE_TEST_SUITE_P(Partitions, ExcerptTest, testing::Bool(),
                         [](const auto& random) { return random.param ? "random" : "metis"; });

TEST_P(ExcerptTest, RingsGoFromPointToPoint) {
  std::vector<std::uint8_t> expected(mesh.cells.size(), most + 1);
  expected[middle] = 0;
  for (std::uint8_t next = 1; next <= most; ++next) {
    std::set<GlobalIndex> reached;
    for (std::size_t cell = 0; cell < expected.size(); ++cell)
      if (expected[cell] < next) reached.insert(mesh.cells[cell].begin(), mesh.cells[cell].end());
    for (std::size_t cell = 0; cell < expected.size(); ++cell)
      if (std::ranges::any_of(mesh.cells[cell], [&](auto point) { return reached.contains(point); }))
        expected[cell] = std::min(expected[cell], next);
  }
  const auto found = rings();
  ASSERT_EQ(found.size(), domain.cell_ids.size());
  for (std::size_t cell = 0; cell < found.size(); ++cell)
    EXPECT_EQ(found[cell], expected[static_cast<std::size_t>(domain.cell_ids[cell])]);
}

TEST_P(ExcerptTest, CellsKeepTheirPlacesAndTheirNeighboursThatAreInIt) {
  const auto [part, cells, points, boundary] = excerpt();
  for (std::size_t cell = 0; cell < cells.size(); ++cell) {
    EXPECT_EQ(part.cell_ids[cell], domain.cell_ids[static_cast<std::size_t>(cells[cell])]);
    for (std::size_t corner = 0; corner < 4; ++corner)
      EXPECT_EQ(part.point_ids[static_cast<std::size_t>(part.cell_points[cell][corner])],
                domain.point_ids[static_cast<std::size_t>(
                    domain.cell_points[static_cast<std::size_t>(cells[cell])][corner])]);
  }
  std::size_t faces = 0;
  for (const auto& [left, right] : domain.faces)
    faces += std::ranges::binary_search(cells, left) && std::ranges::binary_search(cells, right);
  EXPECT_EQ(part.faces.size(), faces);
  for (Index cell = 0; cell < part.owned_cells; ++cell)
    for (const Index face : part.cell_faces[cell]) {
      const auto [left, right] = part.faces[static_cast<std::size_t>(face)];
      EXPECT_TRUE(left == cell || right == cell);
    }
  for (Index point = 0; point < part.owned_points; ++point) {
    const auto whole = domain.point_cells[points[static_cast<std::size_t>(point)]];
    EXPECT_EQ(part.point_cells[point].size(), std::ranges::count_if(whole, [&](Index cell) {
                return std::ranges::binary_search(cells, cell);
              }));
  }
  for (std::size_t face = 0; face < boundary.size(); ++face)
    EXPECT_EQ(part.boundary_faces[face].id,
              domain.boundary_faces[static_cast<std::size_t>(boundary[face])].id);
  auto again = part;
  again.update_metrics();
  EXPECT_EQ(again.volume, part.volume);
}

TEST_P(ExcerptTest, GhostsAreFilled) {
  const auto part = excerpt().domain;
  for (const HaloWidth width : {HaloWidth::points, HaloWidth::faces}) {
    std::vector<GlobalIndex> ids(static_cast<std::size_t>(part.total_cells), -1);
    std::copy_n(part.cell_ids.begin(), part.owned_cells, ids.begin());
    HaloExchange<GlobalIndex>(part, comm, ids, width).exchange();
    for (const auto& neighbour : part.neighbours)
      for (Index i = 0; i < neighbour.ghost_count; ++i) {
        const auto ghost = static_cast<std::size_t>(neighbour.ghost_begin + i);
        const bool is_filled = width == HaloWidth::points || i < neighbour.ghost_face_count;
        EXPECT_EQ(ids[ghost], is_filled ? part.cell_ids[ghost] : -1);
      }
  }
}

}  // namespace
}  // namespace alphadot
