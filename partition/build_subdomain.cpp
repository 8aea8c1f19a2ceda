#include "partition/build_subdomain.hpp"

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <span>
#include <stdexcept>
#include <tuple>
#include <utility>

#include "partition/dual_graph.hpp"
#include "partition/face_matching.hpp"
#include "partition/ordering.hpp"

namespace alphadot {

namespace {

template <class T>
std::vector<T> permuted(const std::vector<T>& values, const std::vector<Index>& order) {
  std::vector<T> out;
  out.reserve(order.size());
  for (const Index i : order) out.push_back(values[i]);
  return out;
}

class Builder {
 public:
  Builder(RankMesh rank_mesh, Real scale) : mesh_(std::move(rank_mesh)), owned_(mesh_.owned_cells()) {
    for (Vec3& point : mesh_.points) point = scale * point;
    domain_.owned_cells = owned_;
    domain_.total_cells = static_cast<Index>(mesh_.cell_ids.size());
    domain_.global_cells = mesh_.global_cells;
    domain_.global_points = mesh_.global_points;
    domain_.patch_names = mesh_.patch_names;
  }

  Subdomain build() {
    number_cells();
    number_points();
    find_faces();
    find_rows();
    find_neighbours();
    domain_.update_metrics();
    return std::move(domain_);
  }

 private:
  int ghost_owner(Index cell) const { return mesh_.ghost_owner[cell - owned_]; }
  std::span<const FaceCells> cut_faces() const {
    return std::span(domain_.faces).subspan(static_cast<std::size_t>(domain_.cut_face_begin));
  }

  void number_cells() {
    const Adjacency graph = dual_graph(mesh_.cell_points, mesh_.points.size());
    std::vector<Index> order = downstream_order(graph, centers_of_owned());
    move_interior_first(order);

    // Ghosts by owner; then those across a face, so that an exchange of them alone is one range; then by
    // global id, which the owner knows too.
    std::vector<Index> ghosts(mesh_.ghost_owner.size());
    std::iota(ghosts.begin(), ghosts.end(), owned_);
    const auto place = [&](Index ghost) {
      const auto across = graph[ghost];
      const bool shares_face =
          std::any_of(across.begin(), across.end(), [&](Index cell) { return cell < owned_; });
      return std::tuple(ghost_owner(ghost), !shares_face, mesh_.cell_ids[ghost]);
    };
    std::sort(ghosts.begin(), ghosts.end(), [&](Index a, Index b) { return place(a) < place(b); });

    order.insert(order.end(), ghosts.begin(), ghosts.end());
    domain_.cell_ids = permuted(mesh_.cell_ids, order);
    domain_.cell_points = permuted(mesh_.cell_points, order);
    for (Index& ghost : ghosts) ghost -= owned_;
    mesh_.ghost_owner = permuted(mesh_.ghost_owner, ghosts);
  }

  std::vector<Vec3> centers_of_owned() const {
    std::vector<Vec3> centers(static_cast<std::size_t>(owned_));
    for (std::size_t cell = 0; cell < centers.size(); ++cell)
      for (const Index point : mesh_.cell_points[cell]) centers[cell] += 0.25 * mesh_.points[point];
    return centers;
  }

  void move_interior_first(std::vector<Index>& order) {
    std::vector<char> on_ghost(mesh_.points.size(), 0);
    for (std::size_t ghost = static_cast<std::size_t>(owned_); ghost < mesh_.cell_points.size(); ++ghost)
      for (const Index point : mesh_.cell_points[ghost]) on_ghost[point] = 1;
    const auto interior = [&](Index cell) {
      const auto& points = mesh_.cell_points[cell];
      return std::none_of(points.begin(), points.end(), [&](Index point) { return on_ghost[point]; });
    };
    const auto end = std::stable_partition(order.begin(), order.end(), interior);
    domain_.interior_cells = static_cast<Index>(end - order.begin());
  }

  /// Points in the order in which the cells use them.
  void number_points() {
    std::vector<Index> order, number(mesh_.points.size(), -1);
    order.reserve(number.size());
    for (Index cell = 0; cell < domain_.total_cells; ++cell) {
      for (Index& point : domain_.cell_points[cell]) {
        Index& mine = number[point];
        if (mine < 0) {
          mine = static_cast<Index>(order.size());
          order.push_back(point);
        }
        point = mine;
      }
      if (cell == domain_.interior_cells - 1) domain_.interior_points = static_cast<Index>(order.size());
      if (cell == owned_ - 1) domain_.owned_points = static_cast<Index>(order.size());
    }
    domain_.points = permuted(mesh_.points, order);
    domain_.point_ids = permuted(mesh_.point_ids, order);
    for (auto& triangle : mesh_.triangles)
      for (Index& point : triangle) point = number[point];
  }

  void find_faces() {
    struct Face {
      FaceCells cells;
      Index left_side;
    };
    std::vector<Face> faces;
    const Index first_triangle = 4 * domain_.total_cells;
    Index owned_sides = 0;
    const auto visit = [&](std::span<const Index> sides) {
      const Index left = sides[0] / 4;  // sides ascend, and so do their cells
      if (sides.size() != 2 || left >= owned_) return;
      if (sides[1] >= first_triangle) {
        add_boundary_face(sides[0], sides[1] - first_triangle);
        ++owned_sides;
      } else {
        const Index right = sides[1] / 4;
        faces.push_back({{left, right}, sides[0]});
        owned_sides += right < owned_ ? 2 : 1;
      }
    };
    for_each_face<Index>(domain_.cell_points, mesh_.triangles, domain_.points.size(), visit);
    if (owned_sides != 4 * owned_)
      throw std::logic_error("the mesh has faces with neither a second cell nor a boundary triangle");

    std::sort(faces.begin(), faces.end(), [&](const Face& a, const Face& b) {
      const auto place = [&](const FaceCells& f) { return std::tuple(f.right >= owned_, f.left, f.right); };
      return place(a.cells) < place(b.cells);
    });
    domain_.faces.reserve(faces.size());
    domain_.face_points.reserve(faces.size());
    for (const Face& face : faces) {
      domain_.faces.push_back(face.cells);
      domain_.face_points.push_back(side_points<Index>(domain_.cell_points, face.left_side));
      if (face.cells.right < owned_) ++domain_.cut_face_begin;
    }
    std::sort(domain_.boundary_faces.begin(), domain_.boundary_faces.end(),
              [](const BoundaryFace& a, const BoundaryFace& b) {
                return std::tie(a.patch, a.cell, a.id) < std::tie(b.patch, b.cell, b.id);
              });
  }

  void add_boundary_face(Index side, Index triangle) {
    domain_.boundary_faces.push_back({side / 4, mesh_.triangle_patch[triangle],
                                      side_points<Index>(domain_.cell_points, side),
                                      mesh_.triangle_ids[triangle]});
  }

  void find_rows() {
    domain_.cell_faces = collect_rows(owned_, static_cast<Index>(domain_.faces.size()), [&](Index face) {
      return std::array{domain_.faces[face].left, domain_.faces[face].right};
    });
    domain_.point_cells = collect_rows(domain_.owned_points, domain_.total_cells,
                                       [&](Index cell) { return domain_.cell_points[cell]; });
  }

  void find_neighbours() {
    std::vector<char> across_face(mesh_.ghost_owner.size(), 0);
    for (const auto& face : cut_faces()) across_face[face.right - owned_] = 1;
    for (Index ghost = owned_; ghost < domain_.total_cells; ++ghost) {
      if (domain_.neighbours.empty() || domain_.neighbours.back().rank != ghost_owner(ghost))
        domain_.neighbours.push_back({ghost_owner(ghost), {}, 0, ghost, 0, 0});
      auto& neighbour = domain_.neighbours.back();
      ++neighbour.ghost_count;
      neighbour.ghost_face_count += across_face[ghost - owned_];
    }
    for (auto& neighbour : domain_.neighbours) find_sends(neighbour);
  }

  /// The owned cells that are ghosts over there are those that share a point with a ghost from there;
  /// likewise with faces. Ordered as number_cells() orders ghosts.
  void find_sends(HaloNeighbour& neighbour) {
    const Index begin = neighbour.ghost_begin, end = begin + neighbour.ghost_count;
    const auto from_there = [&](Index cell) { return cell >= begin && cell < end; };
    enum class Shared : char { nothing, point, face };
    std::vector<Shared> shared(static_cast<std::size_t>(owned_), Shared::nothing);
    for (Index ghost = begin; ghost < end; ++ghost)
      for (const Index point : domain_.cell_points[ghost])
        if (point < domain_.owned_points)
          for (const Index cell : domain_.point_cells[point])
            if (cell < owned_) shared[cell] = Shared::point;
    for (const auto& face : cut_faces())
      if (from_there(face.right)) shared[face.left] = Shared::face;

    for (Index cell = domain_.interior_cells; cell < owned_; ++cell)
      if (shared[cell] != Shared::nothing) neighbour.send.push_back(cell);
    neighbour.send_face_count = static_cast<Index>(std::count(shared.begin(), shared.end(), Shared::face));
    const auto place = [&](Index cell) {
      return std::tuple(shared[cell] != Shared::face, domain_.cell_ids[cell]);
    };
    std::sort(neighbour.send.begin(), neighbour.send.end(),
              [&](Index a, Index b) { return place(a) < place(b); });
  }

  RankMesh mesh_;
  const Index owned_;
  Subdomain domain_;
};

}  // namespace

Subdomain build_subdomain(RankMesh rank_mesh, Real scale) {
  return Builder(std::move(rank_mesh), scale).build();
}

}  // namespace alphadot
