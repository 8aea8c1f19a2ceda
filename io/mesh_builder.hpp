// Puts together the mesh that a reader finds in its file.
#pragma once

#include <array>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "io/bounded_growth.hpp"
#include "io/scanner.hpp"
#include "partition/mesh.hpp"

namespace alphadot {

/// Collects points, tetrahedra and named triangles, and counts the elements that the solver cannot take, so
/// that one message can tell of all of them.
class MeshBuilder {
 public:
  explicit MeshBuilder(std::string file);

  std::vector<Vec3>& points() { return mesh_.points; }
  std::vector<std::array<GlobalIndex, 4>>& cells() { return mesh_.cells; }
  /// The patch of that name, made at the first call; later calls may move it.
  Patch& patch(std::string_view name, const Scanner& scanner);
  bool has_patch(std::string_view name) const { return patches_.contains(name); }

  /// Notes elements other than linear tetrahedra and triangles; `plural` names them and is a literal.
  void refuse(std::string_view plural, GlobalIndex count) { refused_[plural] += count; }
  /// Throws InputError at the scanner's place when elements were refused.
  void check_refused(const Scanner& scanner) const;

  /// The mesh without the points that neither cells nor triangles use. Throws InputError when there are no
  /// cells, with `remedy`.
  Mesh finish(const std::string& remedy) &&;

 private:
  void drop_unused_points();

  Mesh mesh_;
  std::map<std::string, std::size_t, std::less<>> patches_;
  std::map<std::string_view, GlobalIndex> refused_;
};

/// x, y and z of the next point.
inline Vec3 read_coordinates(Scanner& scanner) {
  // Braces read them in this order.
  return Vec3{scanner.read_real("x of a point"), scanner.read_real("y of a point"),
              scanner.read_real("z of a point")};
}

}  // namespace alphadot
