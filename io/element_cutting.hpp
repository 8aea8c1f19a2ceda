// Cuts pyramids, prisms, hexahedra and quadrilaterals into tetrahedra and triangles that fit together.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "core/types.hpp"
#include "core/vec3.hpp"

namespace alphadot {

/// The shapes that a mesh file may hold. Corners are numbered as in VTK, SU2, CGNS and Gmsh: the base first,
/// then the apex or the opposite side in the same sense.
enum class Shape { triangle, quadrilateral, tetrahedron, pyramid, prism, hexahedron };

/// Corners of one shape.
constexpr std::size_t corner_count(Shape shape) {
  constexpr std::array<std::size_t, 6> counts{3, 4, 4, 5, 6, 8};
  return counts[static_cast<std::size_t>(shape)];
}
/// For messages: "prisms".
const char* plural(Shape shape);

/// The triangles of a triangle or quadrilateral, in its sense of rotation: the diagonal starts at the corner
/// with the smallest id, so that both sides of a face choose the same one (Dompierre, Labbé, Vallet and
/// Camarero, "How to subdivide pyramids, prisms and hexahedra into tetrahedra", 8th International Meshing
/// Roundtable, 1999). Corners that coincide make it a triangle or nothing.
template <std::size_t n, class Act>
void for_each_triangle(const std::array<GlobalIndex, n>& corners, Act&& act) {
  std::array<GlobalIndex, n> ring;
  std::size_t size = 0;
  for (std::size_t i = 0; i < n; ++i)
    if (corners[i] != corners[(i + 1) % n]) ring[size++] = corners[i];
  if (size < 3 || (size == 4 && (ring[0] == ring[2] || ring[1] == ring[n - 1]))) return;
  std::rotate(ring.begin(), std::min_element(ring.begin(), ring.begin() + size), ring.begin() + size);
  for (std::size_t i = 1; i + 1 < size; ++i) act(std::array{ring[0], ring[i], ring[i + 1]});
}

/// What became of the elements of one shape.
struct CuttingTally {
  GlobalIndex elements = 0;
  GlobalIndex tetrahedra = 0;
  GlobalIndex with_inner_point = 0;  ///< elements that needed one
  GlobalIndex left_handed = 0;       ///< elements whose corners ran the other way round
  GlobalIndex collapsed = 0;         ///< elements without volume, left out
  GlobalIndex thin = 0;              ///< elements whose longest edge is more than 50 times the shortest

  /// The scaled Jacobian (Knupp, "Algebraic mesh quality metrics for unstructured initial meshes", 2003): the
  /// least over the corners of the product of three unit edges, over that of the ideal shape; 1 is ideal.
  struct Quality {
    Real least = 1, sum = 0;
    void add(Real value) {
      least = std::min(least, value);
      sum += value;
    }
  };
  Quality before, after;

  CuttingTally& operator+=(const CuttingTally& other);
};

/// Appends to `cells` the tetrahedra, of positive volume, of elements with 5, 6 or 8 corners. Faces are cut
/// as for_each_triangle() does. The element is seen from its corner with the smallest id: the triangles of
/// all faces that do not touch it are joined to it, two, three or six of them. Where that makes a tetrahedron
/// without volume (warped faces), all faces are joined to a new point at the mean of the corners instead, if
/// that makes none. Corners that coincide are allowed.
template <std::size_t n>
CuttingTally cut_elements(std::span<const std::array<GlobalIndex, n>> elements, std::vector<Vec3>& points,
                          std::vector<std::array<GlobalIndex, 4>>& cells);

}  // namespace alphadot
