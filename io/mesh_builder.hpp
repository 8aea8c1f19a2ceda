// Puts together the mesh that a reader finds in its file.
#pragma once

#include <algorithm>
#include <array>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "io/bounded_growth.hpp"
#include "io/element_cutting.hpp"
#include "io/mesh_of_file.hpp"
#include "io/scanner.hpp"

namespace alphadot {

/// A named part of the boundary as it stands in a file.
struct Surface {
  std::string name;
  std::vector<std::array<GlobalIndex, 3>> triangles;
  std::vector<std::array<GlobalIndex, 4>> quadrilaterals;
};

/// Collects points, elements of any shape and named surfaces, and makes tetrahedra and triangles of them.
class MeshBuilder {
 public:
  explicit MeshBuilder(std::string file);

  std::vector<Vec3>& points() { return mesh_.points; }
  std::vector<std::array<GlobalIndex, 4>>& cells() { return mesh_.cells; }
  /// The surface of that name, made at the first call; later calls may move it. `in` is what is read: see
  /// largest_array(). Fails for more surfaces than a mesh has, and for more than its file can tell apart.
  template <class Source>
  Surface& surface(std::string_view name, const Source& in) {
    if (const auto found = surfaces_by_name_.find(name); found != surfaces_by_name_.end())
      return surfaces_[found->second];
    const std::size_t most = std::min(most_surfaces, largest_array(in) / surface_bytes);
    if (surfaces_.size() == most)
      in.fail("more than " + std::to_string(most) + " boundary patches",
              "check that boundaries, not single triangles, are numbered");
    surfaces_by_name_.emplace(name, surfaces_.size());
    return surfaces_.emplace_back(Surface{std::string(name), {}, {}});
  }
  bool has_surface(std::string_view name) const { return surfaces_by_name_.contains(name); }

  /// Calls act(elements) with the array of that shape, which is one of a volume.
  template <class Act>
  void with_volumes(Shape shape, Act&& act) {
    if (shape == Shape::tetrahedron) act(mesh_.cells);
    if (shape == Shape::pyramid) act(pyramids_);
    if (shape == Shape::prism) act(prisms_);
    if (shape == Shape::hexahedron) act(hexahedra_);
  }
  /// The same with an array of a surface.
  template <class Act>
  static void with_faces(Shape shape, Surface& surface, Act&& act) {
    if (shape == Shape::triangle) act(surface.triangles);
    if (shape == Shape::quadrilateral) act(surface.quadrilaterals);
  }

  /// Volume elements that follow belong to the volume of that name.
  void begin_volume(std::string_view name);
  /// Notes volume elements of which only the corners are used.
  void add_curved(GlobalIndex count) { curved_ += count; }
  /// Leaves a remark for the person who gave the file.
  void note(std::string text) { mesh_.notes.push_back(std::move(text)); }

  /// The mesh: elements cut into tetrahedra and triangles, left-handed ones turned, without the points that
  /// nothing uses; its notes tell what was done. Throws InputError when there are no cells, with `remedy`.
  MeshOfFile finish(const std::string& remedy) &&;

 private:
  // More names than any mesh has: such a file numbers something else in the place of its boundaries.
  static constexpr std::size_t most_surfaces = 10'000;
  // Of a surface with its names and lists, before it has elements.
  static constexpr std::size_t surface_bytes = 256;

  void fail_without_cells(const std::string& remedy) const;
  /// Of tetrahedra, whose points it notes on the way: a pass of its own takes as long as all of this.
  void turn_left_handed();
  void cut();
  template <std::size_t n>
  CuttingTally cut(std::vector<std::array<GlobalIndex, n>>& elements, std::size_t shape);
  /// Numbers of tetrahedra, pyramids, prisms and hexahedra so far.
  std::array<std::size_t, 4> sizes() const {
    return {mesh_.cells.size(), pyramids_.size(), prisms_.size(), hexahedra_.size()};
  }
  void make_patches();
  void drop_unused_points(std::size_t first_cut);

  MeshOfFile mesh_;
  std::vector<bool> is_used_;  ///< [points]
  std::vector<std::array<GlobalIndex, 5>> pyramids_;
  std::vector<std::array<GlobalIndex, 6>> prisms_;
  std::vector<std::array<GlobalIndex, 8>> hexahedra_;
  /// Where in the four arrays a volume, or another stretch of one, begins.
  struct VolumeStart {
    std::string name;
    std::array<std::size_t, 4> first;
  };
  std::vector<VolumeStart> volume_starts_;
  std::vector<Surface> surfaces_;
  std::map<std::string, std::size_t, std::less<>> surfaces_by_name_;
  GlobalIndex curved_ = 0;
};

/// x, y and z of the next point.
inline Vec3 read_coordinates(Scanner& scanner) {
  // Braces read them in this order.
  return Vec3{scanner.read_real("x of a point"), scanner.read_real("y of a point"),
              scanner.read_real("z of a point")};
}

}  // namespace alphadot
