#include "partition/thin_walls.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <set>

#include "core/error.hpp"
#include "partition/adjacency.hpp"
#include "partition/disjoint_sets.hpp"
#include "partition/face_matching.hpp"

namespace alphadot {

namespace {

/// A triangle of a patch.
struct Place {
  std::size_t patch, triangle;
};

/// A triangle with a cell on either side.
struct Wall {
  Place place;
  std::array<Index, 2> sides;  ///< as for_each_face() numbers them
};

/// How the cells of a mesh hang together about its thin walls.
class Surroundings {
 public:
  Surroundings(const Mesh& mesh, const std::vector<bool>& is_thin)
      : mesh_(mesh), across_(4 * mesh.cells.size(), -1), has_inner_(mesh.patches.size(), false) {
    match_faces(is_thin);
    leave_walls_between_parts();
    join_about_points();
  }

  const std::vector<Wall>& walls() const { return walls_; }
  /// Whether a patch has a triangle between two cells, also one that parts the mesh.
  bool has_inner_triangle(std::size_t patch) const { return has_inner_[patch]; }

  /// Whether the cells on both sides hang together about all three points: the sides cannot be told apart.
  bool has_free_edges_all_round(const Wall& wall) {
    return std::ranges::all_of(side_points<GlobalIndex>(mesh_.cells, wall.sides[0]), [&](GlobalIndex point) {
      return fan(point, wall.sides[0] / 4) == fan(point, wall.sides[1] / 4);
    });
  }

  /// Gives every fan of cells about a point of a wall a point of its own, and every triangle those of its
  /// cell. Triangles of walls come twice then.
  void open(Mesh& mesh) {
    std::vector<GlobalIndex> id_of_fan(cells_about_.items.size(), -1);
    std::vector<std::array<GlobalIndex, 4>> cells = mesh.cells;
    for (std::size_t point = 0; point < number_.size(); ++point) {
      if (number_[point] < 0) continue;
      bool is_first = true;
      for (const Index cell : cells_about_[number_[point]]) {
        GlobalIndex& id = id_of_fan[fan(static_cast<GlobalIndex>(point), cell)];
        if (id < 0 && is_first) id = static_cast<GlobalIndex>(point);
        if (id < 0) {
          id = static_cast<GlobalIndex>(mesh.points.size());
          mesh.points.push_back(mesh.points[point]);
        }
        is_first = false;
        std::ranges::replace(cells[cell], static_cast<GlobalIndex>(point), id);
      }
    }
    for (const auto& [place, cell] : touching_) {
      auto& triangle = mesh.patches[place.patch].triangles[place.triangle];
      for (GlobalIndex& point : triangle)
        if (number_[point] >= 0) point = id_of_fan[fan(point, cell)];
    }
    mesh.cells = std::move(cells);
    for (const auto& [place, sides] : walls_) {
      auto& triangles = mesh.patches[place.patch].triangles;
      triangles[place.triangle] = side_points<GlobalIndex>(mesh.cells, sides[0]);
      triangles.push_back(side_points<GlobalIndex>(mesh.cells, sides[1]));
    }
  }

 private:
  void match_faces(const std::vector<bool>& is_thin) {
    std::vector<Place> places;
    for (std::size_t patch = 0; patch < mesh_.patches.size(); ++patch)
      for (std::size_t i = 0; i < mesh_.patches[patch].triangles.size(); ++i) places.push_back({patch, i});
    const auto triangles = mesh_.boundary_triangles();
    const auto cell_sides = static_cast<Index>(across_.size());
    for_each_face<GlobalIndex>(mesh_.cells, triangles, mesh_.points.size(),
                               [&](std::span<const Index> sides) {
                                 const bool has_two_cells = sides.size() > 1 && sides[1] < cell_sides;
                                 if (sides.size() == 2 && has_two_cells) {
                                   across_[sides[0]] = sides[1];
                                   across_[sides[1]] = sides[0];
                                 } else if (sides.size() == 2 && sides[0] < cell_sides) {
                                   touching_.push_back({places[sides[1] - cell_sides], sides[0] / 4});
                                 } else if (sides.size() > 2 && has_two_cells && sides[2] >= cell_sides) {
                                   const Place& place = places[sides[2] - cell_sides];
                                   for (const Index side : sides.subspan(2))
                                     has_inner_[places[side - cell_sides].patch] = true;
                                   if (sides.size() == 3 && is_thin[place.patch])
                                     walls_.push_back({place, {sides[0], sides[1]}});
                                   else
                                     for (const Index side : sides.subspan(2))
                                       keep({places[side - cell_sides], {sides[0], sides[1]}});
                                 }
                               });
    std::ranges::sort(walls_, {},
                      [](const Wall& wall) { return std::pair(wall.place.patch, wall.place.triangle); });
  }

  /// Leaves an inner triangle what it is.
  void keep(const Wall& wall) {
    kept_.push_back(wall.sides);
    touching_.push_back({wall.place, wall.sides[0] / 4});
  }

  void leave_walls_between_parts() {
    DisjointSets joined(mesh_.cells.size());
    for (std::size_t side = 0; side < across_.size(); ++side)
      if (across_[side] >= 0) joined.join(static_cast<Index>(side / 4), across_[side] / 4);
    std::erase_if(walls_, [&](const Wall& wall) {
      const bool is_between = joined.root(wall.sides[0] / 4) != joined.root(wall.sides[1] / 4);
      if (is_between) keep(wall);
      return is_between;
    });
    for (const auto& [a, b] : kept_) {
      across_[a] = b;
      across_[b] = a;
    }
  }

  void join_about_points() {
    number_.assign(mesh_.points.size(), -1);
    Index count = 0;
    for (const Wall& wall : walls_)
      for (const GlobalIndex point : side_points<GlobalIndex>(mesh_.cells, wall.sides[0]))
        if (number_[point] < 0) number_[point] = count++;
    const auto cell_count = static_cast<Index>(mesh_.cells.size());
    cells_about_ = collect_rows(count, cell_count, [&](Index cell) {
      std::array<Index, 4> numbers;
      std::ranges::transform(mesh_.cells[cell], numbers.begin(),
                             [&](GlobalIndex point) { return number_[point]; });
      return numbers;
    });
    fans_.emplace(cells_about_.items.size());
    std::erase_if(touching_, [&](const Touching& touching) {
      return std::ranges::none_of(mesh_.patches[touching.place.patch].triangles[touching.place.triangle],
                                  [&](GlobalIndex point) { return number_[point] >= 0; });
    });
    for (std::size_t side = 0; side < across_.size(); ++side) {
      if (across_[side] < static_cast<Index>(side)) continue;
      for (const GlobalIndex point : side_points<GlobalIndex>(mesh_.cells, static_cast<Index>(side)))
        if (number_[point] >= 0)
          fans_->join(entry(point, static_cast<Index>(side / 4)), entry(point, across_[side] / 4));
    }
  }

  /// Where `cell` stands among those about a point of a wall.
  Index entry(GlobalIndex point, Index cell) const {
    const auto cells = cells_about_[number_[point]];
    return cells_about_.begin[number_[point]] +
           static_cast<Index>(std::ranges::lower_bound(cells, cell) - cells.begin());
  }
  /// The cells about a point that hang together with `cell`, through faces that
  /// have that point.
  Index fan(GlobalIndex point, Index cell) { return fans_->root(entry(point, cell)); }

  /// A triangle that stays, with the cell that it is of.
  struct Touching {
    Place place;
    Index cell;
  };

  const Mesh& mesh_;
  std::vector<Index> across_;               ///< [4 cells] the side on the other side; -1 at
                                            ///< walls and boundaries
  std::vector<std::array<Index, 2>> kept_;  ///< sides of inner triangles that are left alone
  std::vector<bool> has_inner_;             ///< [patches]
  std::vector<Wall> walls_;                 ///< by place
  std::vector<Touching> touching_;          ///< those with a point of a wall
  std::vector<Index> number_;               ///< [points] of the walls' points, others -1
  Adjacency cells_about_;                   ///< each of these points
  std::optional<DisjointSets> fans_;        ///< of the entries of cells_about_
};

/// Cuts the cell at the face of `side` in three about a point of that face.
void cut_in_three(Mesh& mesh, Index side, GlobalIndex middle) {
  const std::array<GlobalIndex, 4> cell = mesh.cells[side / 4];
  const std::string volume(mesh.volume_of(side / 4));
  bool is_first = true;
  for (std::size_t corner = 0; corner < 4; ++corner) {
    if (static_cast<Index>(corner) == side % 4) continue;
    auto part = cell;
    part[corner] = middle;
    if (is_first) {
      mesh.cells[side / 4] = part;
    } else {
      if (!mesh.volumes.empty() && mesh.volumes.back().name != volume)
        mesh.volumes.push_back({volume, static_cast<GlobalIndex>(mesh.cells.size())});
      mesh.cells.push_back(part);
    }
    is_first = false;
  }
}

/// Cuts triangles with free edges all round, each with its two cells; of
/// several at one cell the first. Returns how many.
GlobalIndex cut_at_free_edges(Mesh& mesh, Surroundings& surroundings) {
  std::vector<Wall> chosen;
  std::vector<bool> is_taken(mesh.cells.size(), false);
  for (const Wall& wall : surroundings.walls()) {
    const auto [a, b] = wall.sides;
    if (is_taken[a / 4] || is_taken[b / 4] || !surroundings.has_free_edges_all_round(wall)) continue;
    is_taken[a / 4] = is_taken[b / 4] = true;
    chosen.push_back(wall);
  }
  for (const auto& [place, sides] : chosen) {
    auto& triangles = mesh.patches[place.patch].triangles;
    const std::array<GlobalIndex, 3> whole = triangles[place.triangle];
    const auto middle = static_cast<GlobalIndex>(mesh.points.size());
    Vec3 center;
    for (const GlobalIndex point : whole) center += (Real{1} / 3) * mesh.points[point];
    mesh.points.push_back(center);
    for (const Index side : sides) cut_in_three(mesh, side, middle);
    for (std::size_t corner = 0; corner < 3; ++corner) {
      auto part = whole;
      part[corner] = middle;
      if (corner == 0)
        triangles[place.triangle] = part;
      else
        triangles.push_back(part);
    }
  }
  return std::ssize(chosen);
}

std::vector<bool> find_patches(const Mesh& mesh, std::span<const std::string> names) {
  std::vector<bool> is_thin(mesh.patches.size(), false);
  for (const auto& name : names) {
    const auto found = std::ranges::find(mesh.patches, name, &Patch::name);
    if (found == mesh.patches.end()) {
      std::vector<std::string_view> others;
      for (const Patch& patch : mesh.patches) others.push_back(patch.name);
      throw InputError(mesh.file, 0,
                       fmt::format("mesh.thin names \"{}\", which the mesh does not have", name),
                       fmt::format("its patches are {}", fmt::join(others, ", ")));
    }
    is_thin[static_cast<std::size_t>(found - mesh.patches.begin())] = true;
  }
  return is_thin;
}

/// Takes out triangles of a patch that stand in it before, as where a file lists a surface from both sides.
/// Returns how many.
std::size_t drop_repeated(Patch& patch) {
  using Triangle = std::array<GlobalIndex, 3>;
  const auto sorted = [](Triangle triangle) {
    std::ranges::sort(triangle);
    return triangle;
  };
  std::set<Triangle> seen;
  return std::erase_if(patch.triangles,
                       [&](const Triangle& triangle) { return !seen.insert(sorted(triangle)).second; });
}

}  // namespace

std::vector<std::string> open_thin_walls(Mesh& mesh, std::span<const std::string> patches) {
  const auto is_thin = find_patches(mesh, patches);
  std::vector<std::string> notes;
  std::size_t triangles = 0;
  for (const Patch& patch : mesh.patches) triangles += patch.triangles.size();
  if (patches.empty() ||
      static_cast<GlobalIndex>(std::max(mesh.cells.size(), triangles)) > max_cells_for_faces)
    return notes;

  for (std::size_t patch = 0; patch < mesh.patches.size(); ++patch)
    if (const auto count = is_thin[patch] ? drop_repeated(mesh.patches[patch]) : 0; count > 0)
      notes.push_back(fmt::format("patch \"{}\": {} triangles that are listed twice are taken once",
                                  mesh.patches[patch].name, count));
  std::optional<Surroundings> surroundings(std::in_place, mesh, is_thin);
  for (std::size_t patch = 0; patch < mesh.patches.size(); ++patch)
    if (is_thin[patch] && !surroundings->has_inner_triangle(patch))
      throw InputError(
          mesh.file, 0,
          fmt::format("mesh.thin names \"{}\", which has nothing inside the mesh", mesh.patches[patch].name),
          "leave it out of mesh.thin; it is a wall with one side already");
  const std::vector<Wall> walls = surroundings->walls();
  GlobalIndex cut = 0;
  while (const GlobalIndex now = cut_at_free_edges(mesh, *surroundings)) {
    cut += now;
    surroundings.emplace(mesh, is_thin);
  }
  surroundings->open(mesh);
  for (std::size_t patch = 0; patch < mesh.patches.size(); ++patch) {
    if (!is_thin[patch]) continue;
    const auto count = std::ranges::count(walls, patch, [](const Wall& wall) { return wall.place.patch; });
    if (count == 0) continue;  // it parts the mesh
    notes.push_back(fmt::format("patch \"{}\": {} triangles inside the mesh are a wall with two sides",
                                mesh.patches[patch].name, count));
  }
  if (cut > 0)
    notes.push_back(
        fmt::format("{} triangles of walls with two sides, with free edges "
                    "all round, were cut in three",
                    cut));
  return notes;
}

}  // namespace alphadot
