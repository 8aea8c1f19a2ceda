#include "partition/excerpt.hpp"

#include <algorithm>
#include <array>

#include "partition/halo.hpp"

namespace alphadot {

std::vector<std::uint8_t> rings_around(const Subdomain& domain, std::span<const std::uint8_t> marked,
                                       int most, const Communicator& comm) {
  const auto beyond = static_cast<std::uint8_t>(most + 1);
  std::vector<std::uint8_t> ring(static_cast<std::size_t>(domain.total_cells), beyond);
  for (std::size_t cell = 0; cell < marked.size(); ++cell)
    if (marked[cell] != 0) ring[cell] = 0;
  HaloExchange<std::uint8_t> halo(domain, comm, ring);
  halo.exchange();
  for (std::uint8_t next = 1; next < beyond; ++next) {
    for (Index point = 0; point < domain.owned_points; ++point) {
      const auto cells = domain.point_cells[point];
      const auto is_inside = [&](Index cell) { return ring[static_cast<std::size_t>(cell)] < next; };
      if (std::ranges::none_of(cells, is_inside)) continue;
      for (const Index cell : cells) {
        auto& of_cell = ring[static_cast<std::size_t>(cell)];
        of_cell = std::min(of_cell, next);
      }
    }
    halo.exchange();
  }
  return ring;
}

namespace {

/// Numbers in an excerpt of what is kept of the whole; -1 of what is not.
class Numbering {
 public:
  template <class IsKept>
  Numbering(std::size_t whole, IsKept&& is_kept) : number_(whole, -1) {
    for (std::size_t i = 0; i < whole; ++i)
      if (is_kept(i)) {
        number_[i] = static_cast<Index>(kept_.size());
        kept_.push_back(static_cast<Index>(i));
      }
  }
  Index operator[](Index of_whole) const { return number_[static_cast<std::size_t>(of_whole)]; }
  template <std::size_t n>
  std::array<Index, n> operator[](std::array<Index, n> of_whole) const {
    for (Index& i : of_whole) i = (*this)[i];
    return of_whole;
  }
  /// How many of the first so many of the whole are kept.
  Index of_first(Index count) const {
    return static_cast<Index>(std::ranges::lower_bound(kept_, count) - kept_.begin());
  }
  const std::vector<Index>& kept() const { return kept_; }

  template <class T>
  std::vector<T> of(const std::vector<T>& whole) const {
    std::vector<T> out;
    out.reserve(kept_.size());
    for (const Index i : kept_) out.push_back(whole[static_cast<std::size_t>(i)]);
    return out;
  }
  /// The rows of those that are kept among the first so many, and what is kept of each.
  Adjacency rows(const Adjacency& whole, Index count, const Numbering& of_items) const {
    Adjacency out;
    for (Index row = 0; row < of_first(count); ++row) {
      for (const Index item : whole[kept_[static_cast<std::size_t>(row)]])
        if (of_items[item] >= 0) out.items.push_back(of_items[item]);
      out.begin.push_back(static_cast<Index>(out.items.size()));
    }
    return out;
  }

 private:
  std::vector<Index> number_, kept_;
};

/// Both sides of an exchange leave out the same cells.
HaloNeighbour neighbour_of(const HaloNeighbour& whole, const Numbering& cells) {
  const auto ghosts_to = [&](Index count) { return cells.of_first(whole.ghost_begin + count); };
  HaloNeighbour out{.rank = whole.rank,
                    .send = {},
                    .send_face_count = 0,
                    .ghost_begin = ghosts_to(0),
                    .ghost_count = ghosts_to(whole.ghost_count) - ghosts_to(0),
                    .ghost_face_count = ghosts_to(whole.ghost_face_count) - ghosts_to(0)};
  for (std::size_t i = 0; i < whole.send.size(); ++i) {
    if (cells[whole.send[i]] < 0) continue;
    out.send.push_back(cells[whole.send[i]]);
    if (static_cast<Index>(i) < whole.send_face_count) ++out.send_face_count;
  }
  return out;
}

}  // namespace

Excerpt excerpt_of(const Subdomain& whole, std::span<const std::uint8_t> kept) {
  std::vector<std::uint8_t> has_cell(whole.points.size(), 0);
  for (std::size_t cell = 0; cell < kept.size(); ++cell)
    if (kept[cell] != 0)
      for (const Index point : whole.cell_points[cell]) has_cell[static_cast<std::size_t>(point)] = 1;
  const Numbering cells(kept.size(), [&](std::size_t cell) { return kept[cell] != 0; }),
      points(whole.points.size(), [&](std::size_t point) { return has_cell[point] != 0; }),
      faces(whole.faces.size(),
            [&](std::size_t face) {
              const auto [left, right] = whole.faces[face];
              return cells[left] >= 0 && cells[right] >= 0;
            }),
      boundary(whole.boundary_faces.size(),
               [&](std::size_t face) { return cells[whole.boundary_faces[face].cell] >= 0; });

  Excerpt out{{}, cells.kept(), points.kept(), boundary.kept()};
  Subdomain& domain = out.domain;
  domain.interior_cells = cells.of_first(whole.interior_cells);
  domain.owned_cells = cells.of_first(whole.owned_cells);
  domain.total_cells = cells.of_first(whole.total_cells);
  domain.global_cells = whole.global_cells;
  domain.global_points = whole.global_points;
  domain.points = points.of(whole.points);
  domain.point_ids = points.of(whole.point_ids);
  domain.interior_points = points.of_first(whole.interior_points);
  domain.owned_points = points.of_first(whole.owned_points);
  for (const auto& corners : cells.of(whole.cell_points)) domain.cell_points.push_back(points[corners]);
  domain.cell_ids = cells.of(whole.cell_ids);
  domain.volume = cells.of(whole.volume);
  domain.center = cells.of(whole.center);
  for (const auto& [left, right] : faces.of(whole.faces)) domain.faces.push_back({cells[left], cells[right]});
  domain.cut_face_begin = faces.of_first(whole.cut_face_begin);
  domain.face_normal = faces.of(whole.face_normal);
  domain.face_center = faces.of(whole.face_center);
  for (const auto& corners : faces.of(whole.face_points)) domain.face_points.push_back(points[corners]);
  domain.patch_names = whole.patch_names;
  for (const auto& face : boundary.of(whole.boundary_faces))
    domain.boundary_faces.push_back({cells[face.cell], face.patch, points[face.points], face.id});
  domain.boundary_normal = boundary.of(whole.boundary_normal);
  domain.boundary_center = boundary.of(whole.boundary_center);
  domain.cell_faces = cells.rows(whole.cell_faces, whole.owned_cells, faces);
  domain.point_cells = points.rows(whole.point_cells, whole.owned_points, cells);
  for (const auto& neighbour : whole.neighbours) domain.neighbours.push_back(neighbour_of(neighbour, cells));
  return out;
}

}  // namespace alphadot
