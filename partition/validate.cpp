#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <stdexcept>
#include <tuple>
#include <utility>

#include "partition/subdomain.hpp"

namespace alphadot {

namespace {

/// Throws with the message when `holds` is false.
template <class... Args>
void require(bool holds, fmt::format_string<Args...> message, Args&&... args) {
  if (!holds) throw std::logic_error("subdomain: " + fmt::format(message, std::forward<Args>(args)...));
}

/// Access by signed index.
template <class T>
const T& at(const std::vector<T>& values, Index i) {
  return values[i];
}

template <class T>
Index count(const std::vector<T>& values) {
  return static_cast<Index>(values.size());
}

template <std::size_t n>
bool has(const std::array<Index, n>& points, Index point) {
  return std::find(points.begin(), points.end(), point) != points.end();
}

void check_sizes(const Subdomain& d) {
  require(0 <= d.interior_cells && d.interior_cells <= d.owned_cells && 0 < d.owned_cells &&
              d.owned_cells <= d.total_cells,
          "{} interior, {} owned, {} cells in all", d.interior_cells, d.owned_cells, d.total_cells);
  for (const Index size : {count(d.cell_points), count(d.cell_ids), count(d.volume), count(d.center)})
    require(size == d.total_cells, "an array of cells has {} entries, not {}", size, d.total_cells);
  for (const Index size : {count(d.face_points), count(d.face_normal), count(d.face_center)})
    require(size == count(d.faces), "an array of faces has {} entries, not {}", size, d.faces.size());
  for (const Index size : {count(d.boundary_normal), count(d.boundary_center)})
    require(size == count(d.boundary_faces), "an array of boundary faces has {} entries, not {}", size,
            d.boundary_faces.size());
  require(count(d.point_ids) == count(d.points) && 0 <= d.interior_points &&
              d.interior_points <= d.owned_points && d.owned_points <= count(d.points),
          "{} points, {} interior, {} owned, {} ids", d.points.size(), d.interior_points, d.owned_points,
          d.point_ids.size());
  require(0 <= d.cut_face_begin && d.cut_face_begin <= count(d.faces), "cut faces begin at {}",
          d.cut_face_begin);
  require(d.cell_faces.rows() == d.owned_cells && d.point_cells.rows() == d.owned_points,
          "cell_faces has {} rows, point_cells {}", d.cell_faces.rows(), d.point_cells.rows());
}

void check_global_ids(std::vector<GlobalIndex> ids, GlobalIndex end, const char* kind) {
  std::sort(ids.begin(), ids.end());
  require(ids.empty() || (ids.front() >= 0 && ids.back() < end), "a {} has a global id outside [0, {})", kind,
          end);
  require(std::adjacent_find(ids.begin(), ids.end()) == ids.end(), "two {}s have the same global id", kind);
}

void check_cells(const Subdomain& d) {
  for (Index cell = 0; cell < d.total_cells; ++cell) {
    require(at(d.volume, cell) > 0, "cell {} has the volume {}", cell, at(d.volume, cell));
    const bool owned = cell < d.owned_cells;
    bool touches_owned = owned, touches_ghost = !owned;
    for (const Index point : at(d.cell_points, cell)) {
      require(0 <= point && point < (owned ? d.owned_points : count(d.points)), "cell {} has the point {}",
              cell, point);
      if (point >= d.owned_points) continue;
      touches_owned = true;  // the check of point_cells makes sure of it
      touches_ghost |= d.point_cells[point].back() >= d.owned_cells;
    }
    require(touches_owned, "ghost {} touches no owned cell", cell);
    require(touches_ghost == (cell >= d.interior_cells),
            "cell {} is on the wrong side of interior_cells = {}", cell, d.interior_cells);
  }
}

void check_point_cells(const Subdomain& d) {
  std::size_t uses = 0;  // of owned points, by all cells
  for (const auto& points : d.cell_points)
    uses += static_cast<std::size_t>(
        std::count_if(points.begin(), points.end(), [&](Index point) { return point < d.owned_points; }));
  require(d.point_cells.items.size() == uses, "point_cells lists {} uses of points, not {}",
          d.point_cells.items.size(), uses);
  for (Index point = 0; point < d.owned_points; ++point) {
    const auto cells = d.point_cells[point];
    require(std::is_sorted(cells.begin(), cells.end(), std::less_equal<>()),
            "cells around point {} do not ascend", point);
    require(!cells.empty() && cells.front() < d.owned_cells, "owned point {} is on no owned cell", point);
    require(point >= d.interior_points || cells.back() < d.owned_cells, "interior point {} is on a ghost",
            point);
    for (const Index cell : cells)
      require(0 <= cell && cell < d.total_cells && has(at(d.cell_points, cell), point),
              "cell {} is not around point {}", cell, point);
  }
}

void check_faces(const Subdomain& d) {
  for (Index face = 0; face < count(d.faces); ++face) {
    const auto [left, right] = at(d.faces, face);
    const bool cut = face >= d.cut_face_begin;
    require(0 <= left && left < d.owned_cells && left < right && right < d.total_cells &&
                cut == (right >= d.owned_cells),
            "face {} is between {} and {}", face, left, right);
    if (face > 0 && face != d.cut_face_begin) {
      const auto previous = at(d.faces, face - 1);
      require(std::tie(previous.left, previous.right) < std::tie(left, right), "face {} is out of order",
              face);
    }
    for (const Index point : at(d.face_points, face))
      require(has(at(d.cell_points, left), point) && has(at(d.cell_points, right), point),
              "point {} of face {} is not on both its cells", point, face);
    require(dot(at(d.face_normal, face), at(d.center, right) - at(d.center, left)) > 0,
            "the normal of face {} does not point from {} to {}", face, left, right);
  }
  Index listed = 0;
  for (Index cell = 0; cell < d.owned_cells; ++cell) {
    Index previous = -1;
    for (const Index face : d.cell_faces[cell]) {
      const auto [left, right] = at(d.faces, face);
      require(left == cell || right == cell, "cell_faces gives face {} to cell {}", face, cell);
      const Index neighbour = left == cell ? right : left;
      require(previous < neighbour, "the neighbours of cell {} do not ascend", cell);
      previous = neighbour;
      ++listed;
    }
  }
  require(listed == count(d.faces) + d.cut_face_begin, "cell_faces lists {} sides, not {}", listed,
          count(d.faces) + d.cut_face_begin);
}

void check_boundary(const Subdomain& d) {
  for (Index face = 0; face < count(d.boundary_faces); ++face) {
    const auto& [cell, patch, points, id] = at(d.boundary_faces, face);
    require(0 <= cell && cell < d.owned_cells && 0 <= patch && patch < count(d.patch_names),
            "boundary face {} is on cell {} and patch {}", face, cell, patch);
    if (face > 0) {
      const auto& previous = at(d.boundary_faces, face - 1);
      require(std::tie(previous.patch, previous.cell, previous.id) < std::tie(patch, cell, id),
              "boundary face {} is out of order", face);
    }
    for (const Index point : points)
      require(has(at(d.cell_points, cell), point), "point {} of boundary face {} is not on its cell", point,
              face);
    require(dot(at(d.boundary_normal, face), at(d.boundary_center, face) - at(d.center, cell)) > 0,
            "the normal of boundary face {} does not point outward", face);
  }
}

/// Outward area vectors of a cell sum to zero, to a few units in the last place of products of its edges.
void check_closed(const Subdomain& d) {
  std::vector<Vec3> sum(static_cast<std::size_t>(d.owned_cells));
  std::vector<Index> sides(static_cast<std::size_t>(d.owned_cells), 0);
  const auto add = [&](Index cell, const Vec3& outward) {
    sum[cell] += outward;
    ++sides[cell];
  };
  for (Index face = 0; face < count(d.faces); ++face) {
    add(at(d.faces, face).left, at(d.face_normal, face));
    if (face < d.cut_face_begin) add(at(d.faces, face).right, -at(d.face_normal, face));
  }
  for (Index face = 0; face < count(d.boundary_faces); ++face)
    add(at(d.boundary_faces, face).cell, at(d.boundary_normal, face));

  for (Index cell = 0; cell < d.owned_cells; ++cell) {
    require(at(sides, cell) == 4, "cell {} has {} faces", cell, at(sides, cell));
    Real longest_squared = 0;
    for (const Index a : at(d.cell_points, cell))
      for (const Index b : at(d.cell_points, cell)) {
        const Vec3 edge = at(d.points, b) - at(d.points, a);
        longest_squared = std::max(longest_squared, dot(edge, edge));
      }
    const Real tolerance = 32 * std::numeric_limits<Real>::epsilon() * longest_squared;
    require(norm(at(sum, cell)) <= tolerance, "cell {} is not closed: its area vectors sum to {:.3g}", cell,
            norm(at(sum, cell)));
  }
}

void check_neighbours(const Subdomain& d) {
  Index next_ghost = d.owned_cells;
  int previous_rank = -1;
  std::vector<char> in_face_range(static_cast<std::size_t>(d.total_cells), 0);
  for (const auto& n : d.neighbours) {
    require(n.rank > previous_rank, "neighbour {} is out of order", n.rank);
    require(n.ghost_begin == next_ghost && n.ghost_count > 0, "ghosts of rank {} begin at {}, not {}", n.rank,
            n.ghost_begin, next_ghost);
    require(0 <= n.ghost_face_count && n.ghost_face_count <= n.ghost_count && 0 <= n.send_face_count &&
                n.send_face_count <= count(n.send),
            "rank {} has more cells across faces than cells", n.rank);
    for (const Index cell : n.send)
      require(d.interior_cells <= cell && cell < d.owned_cells, "cell {} is sent to rank {}", cell, n.rank);
    for (Index i = 0; i < n.ghost_face_count; ++i) in_face_range[n.ghost_begin + i] = 1;
    previous_rank = n.rank;
    next_ghost += n.ghost_count;
  }
  require(next_ghost == d.total_cells, "{} ghosts have no owner", d.total_cells - next_ghost);

  std::vector<char> across_face(static_cast<std::size_t>(d.total_cells), 0);
  for (Index face = d.cut_face_begin; face < count(d.faces); ++face) across_face[at(d.faces, face).right] = 1;
  require(across_face == in_face_range, "the ghosts across faces are not the first ones of their owners");
}

}  // namespace

void Subdomain::validate() const {
  check_sizes(*this);
  check_global_ids(cell_ids, global_cells, "cell");
  check_global_ids(point_ids, global_points, "point");
  check_point_cells(*this);
  check_cells(*this);
  check_faces(*this);
  check_boundary(*this);
  check_closed(*this);
  check_neighbours(*this);
}

}  // namespace alphadot
