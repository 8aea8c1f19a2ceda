#include "partition/reorder.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numeric>
#include <span>
#include <tuple>
#include <utility>

#include "partition/delivery.hpp"
#include "partition/face_matching.hpp"
#include "partition/space_filling_curve.hpp"

namespace alphadot {

namespace {

/// A cell on its way to the rank that numbers its piece.
struct MovingCell {
  int piece;
  std::uint64_t position;  ///< along the curve
  GlobalIndex old_id;
  std::array<GlobalIndex, 4> points;
  auto place() const { return std::tuple(piece, position, old_id); }
};

struct MovingTriangle {
  int piece;
  GlobalIndex cell;  ///< behind it: its old id, then its new one
  BoundaryTriangle triangle;
};

class Orderer {
 public:
  Orderer(const RankMesh& rank_mesh, int pieces, const Communicator& comm)
      : mesh_(rank_mesh), pieces_(pieces), comm_(comm), box_(bounding_box()) {}

  OrderedMesh order(const std::vector<int>& piece, std::vector<Vec3> points) const {
    const auto along = pieces_along_curve(piece);
    std::vector<MovingCell> cells(piece.size());
    for (std::size_t i = 0; i < cells.size(); ++i)
      cells[i] = {along[static_cast<std::size_t>(piece[i])], hilbert_position(center(i), box_),
                  mesh_.cell_ids[i], corners<4>(mesh_.cell_points[i])};
    auto triangles = moving_triangles(cells);
    const auto rank_of = [&](const auto& item) {
      return static_cast<int>(GlobalIndex{item.piece} * comm_.size() / pieces_);
    };
    cells = deliver_to<MovingCell>(cells, rank_of, comm_).items;
    triangles = deliver_to<MovingTriangle>(triangles, rank_of, comm_).items;
    std::sort(cells.begin(), cells.end(), [](const auto& a, const auto& b) { return a.place() < b.place(); });

    OrderedMesh out;
    out.part.global_cells = mesh_.global_cells;
    out.part.global_points = mesh_.global_points;
    out.part.patch_names = mesh_.patch_names;
    out.part.points = std::move(points);
    out.piece_begin.assign(static_cast<std::size_t>(pieces_) + 1, 0);
    for (const auto& cell : cells) ++out.piece_begin[static_cast<std::size_t>(cell.piece) + 1];
    comm_.sum(std::span<GlobalIndex>(out.piece_begin));
    std::partial_sum(out.piece_begin.begin(), out.piece_begin.end(), out.piece_begin.begin());
    number_cells(cells, out.part);
    number_triangles(cells, std::move(triangles), out);
    return out;
  }

 private:
  Box bounding_box() const {
    constexpr Real far = std::numeric_limits<Real>::infinity();
    std::array<Real, 3> lower{far, far, far}, upper{-far, -far, -far};
    for (const Vec3& point : mesh_.points)
      for (int axis = 0; axis < 3; ++axis) {
        const auto i = static_cast<std::size_t>(axis);
        lower[i] = std::min(lower[i], point[axis]);
        upper[i] = std::max(upper[i], point[axis]);
      }
    comm_.min(std::span<Real>(lower));
    comm_.max(std::span<Real>(upper));
    return {{lower[0], lower[1], lower[2]}, {upper[0], upper[1], upper[2]}};
  }

  Vec3 center(std::size_t cell) const {
    Vec3 sum;
    for (const Index point : mesh_.cell_points[cell]) sum += 0.25 * mesh_.points[point];
    return sum;
  }

  template <std::size_t n>
  std::array<GlobalIndex, n> corners(const std::array<Index, n>& local) const {
    std::array<GlobalIndex, n> out;
    for (std::size_t i = 0; i < n; ++i) out[i] = mesh_.point_ids[local[i]];
    return out;
  }

  /// New numbers of the pieces, in the order of their centres along the curve.
  std::vector<int> pieces_along_curve(const std::vector<int>& piece) const {
    std::vector<Real> sums(4 * static_cast<std::size_t>(pieces_), 0);
    for (std::size_t i = 0; i < piece.size(); ++i) {
      const Vec3 at = center(i);
      Real* sum = &sums[4 * static_cast<std::size_t>(piece[i])];
      for (int axis = 0; axis < 3; ++axis) sum[axis] += at[axis];
      sum[3] += 1;
    }
    comm_.sum(std::span<Real>(sums));
    std::vector<std::pair<std::uint64_t, int>> positions;
    for (int i = 0; i < pieces_; ++i) {
      const Real* sum = &sums[4 * static_cast<std::size_t>(i)];
      const Real share = 1 / std::max(sum[3], Real{1});
      positions.emplace_back(hilbert_position({share * sum[0], share * sum[1], share * sum[2]}, box_), i);
    }
    std::sort(positions.begin(), positions.end());
    std::vector<int> out(positions.size());
    for (std::size_t i = 0; i < positions.size(); ++i)
      out[static_cast<std::size_t>(positions[i].second)] = static_cast<int>(i);
    return out;
  }

  /// The boundary triangles with the cells behind them.
  std::vector<MovingTriangle> moving_triangles(const std::vector<MovingCell>& cells) const {
    std::vector<MovingTriangle> out;
    const auto cell_sides = static_cast<Index>(4 * mesh_.cell_points.size());
    for_each_face<Index>(mesh_.cell_points, mesh_.triangles, mesh_.points.size(),
                         [&](std::span<const Index> sides) {
                           if (sides.front() >= cell_sides || sides.back() < cell_sides) return;
                           const auto cell = static_cast<std::size_t>(sides.front() / 4);
                           const auto triangle = static_cast<std::size_t>(sides.back() - cell_sides);
                           out.push_back({cells[cell].piece,
                                          cells[cell].old_id,
                                          {corners<3>(mesh_.triangles[triangle]),
                                           mesh_.triangle_ids[triangle], mesh_.triangle_patch[triangle]}});
                         });
    return out;
  }

  GlobalIndex before_me(std::size_t count) const {
    const auto mine = static_cast<GlobalIndex>(count);
    GlobalIndex before = 0;
    MPI_Exscan(&mine, &before, 1, MPI_INT64_T, MPI_SUM, comm_.handle());
    return before;
  }

  void number_cells(const std::vector<MovingCell>& cells, MeshPart& part) const {
    part.cell_ids.resize(cells.size());
    std::iota(part.cell_ids.begin(), part.cell_ids.end(), before_me(cells.size()));
    part.cells.reserve(cells.size());
    for (const auto& cell : cells) part.cells.push_back(cell.points);
  }

  void number_triangles(const std::vector<MovingCell>& cells, std::vector<MovingTriangle> triangles,
                        OrderedMesh& out) const {
    std::vector<std::pair<GlobalIndex, GlobalIndex>> new_id;  // by old id
    for (std::size_t i = 0; i < cells.size(); ++i) new_id.emplace_back(cells[i].old_id, out.part.cell_ids[i]);
    std::sort(new_id.begin(), new_id.end());
    for (auto& triangle : triangles)
      triangle.cell =
          std::lower_bound(new_id.begin(), new_id.end(), std::pair(triangle.cell, GlobalIndex{0}))->second;
    std::sort(triangles.begin(), triangles.end(), [](const auto& a, const auto& b) {
      return std::tuple(a.cell, a.triangle.id) < std::tuple(b.cell, b.triangle.id);
    });
    GlobalIndex id = before_me(triangles.size());
    for (const auto& triangle : triangles) {
      out.part.triangles.push_back(triangle.triangle);
      out.part.triangles.back().id = id++;
      out.triangle_cell.push_back(triangle.cell);
    }
    out.part.global_triangles = comm_.sum(static_cast<GlobalIndex>(triangles.size()));
  }

  const RankMesh& mesh_;
  int pieces_;
  const Communicator& comm_;
  Box box_;
};

}  // namespace

OrderedMesh reorder(const RankMesh& rank_mesh, const std::vector<int>& piece, int pieces,
                    std::vector<Vec3> points, const Communicator& comm) {
  return Orderer(rank_mesh, pieces, comm).order(piece, std::move(points));
}

}  // namespace alphadot
