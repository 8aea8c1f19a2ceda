#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "fuzz/check_mesh.hpp"
#include "partition/thin_walls.hpp"

namespace {

/// A box of 2 x 2 x 2 cubes of six tetrahedra each (Kuhn's division); its sides are one patch.
alphadot::Mesh box() {
  using namespace alphadot;
  constexpr GlobalIndex n = 2;
  Mesh mesh;
  const auto point = [](const std::array<GlobalIndex, 3>& at) {
    return at[0] + (n + 1) * (at[1] + (n + 1) * at[2]);
  };
  for (GlobalIndex i = 0; i < (n + 1) * (n + 1) * (n + 1); ++i)
    mesh.points.push_back({static_cast<Real>(i % (n + 1)), static_cast<Real>(i / (n + 1) % (n + 1)),
                           static_cast<Real>(i / ((n + 1) * (n + 1)))});
  std::array<int, 3> path{0, 1, 2};
  do {
    const bool is_even = (path[1] - path[0] + 3) % 3 == 1;
    for (GlobalIndex cube = 0; cube < n * n * n; ++cube) {
      std::array<GlobalIndex, 3> at{cube % n, cube / n % n, cube / (n * n)};
      std::array<GlobalIndex, 4> cell{point(at)};
      for (std::size_t i = 0; i < 3; ++i) {
        ++at[static_cast<std::size_t>(path[i])];
        cell[i + 1] = point(at);
      }
      if (!is_even) std::swap(cell[1], cell[2]);
      mesh.cells.push_back(cell);
    }
  } while (std::next_permutation(path.begin(), path.end()));
  Patch sides{"sides", {}};
  for (const auto& cell : mesh.cells)
    for (std::size_t corner = 0; corner < 4; ++corner) {
      const std::array face{cell[(corner + 1) % 4], cell[(corner + 2) % 4], cell[(corner + 3) % 4]};
      for (int d = 0; d < 3; ++d)
        for (const Real end : {Real{0}, Real{n}})
          if (std::all_of(face.begin(), face.end(),
                          [&](GlobalIndex p) { return mesh.points[static_cast<std::size_t>(p)][d] == end; }))
            sides.triangles.push_back(face);
    }
  mesh.patches.push_back(sides);
  return mesh;
}

}  // namespace

/// Any set of inner faces of a box as thin walls: the mesh is sound then, or the walls part it and
/// Mesh::validate() says so. Every two bytes are a cell, one of its sides, and which of two patches gets it.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace alphadot;
  static const Mesh sound = [] {
    Mesh out = box();
    out.validate();  // throws where it is not
    return out;
  }();
  Mesh mesh = sound;
  const std::size_t first = mesh.patches.size();
  mesh.patches.push_back({"fin", {}});
  mesh.patches.push_back({"wing", {}});
  Mesh once = mesh;  // without what a patch lists again
  std::set<std::pair<std::size_t, std::array<GlobalIndex, 3>>> listed;
  for (std::size_t i = 0; i + 1 < size; i += 2) {
    const auto& cell = mesh.cells[data[i] % mesh.cells.size()];
    const std::size_t corner = data[i + 1] % 4;
    const std::size_t patch = first + data[i + 1] / 4 % 2;
    const std::array triangle{cell[(corner + 1) % 4], cell[(corner + 2) % 4], cell[(corner + 3) % 4]};
    auto sorted = triangle;
    std::sort(sorted.begin(), sorted.end());
    mesh.patches[patch].triangles.push_back(triangle);
    if (listed.insert({patch, sorted}).second) once.patches[patch].triangles.push_back(triangle);
  }
  const auto area_of = [&](const Mesh& of) {
    Real out = 0;
    for (std::size_t i = first; i < of.patches.size(); ++i)
      for (const auto& [a, b, c] : of.patches[i].triangles)
        out += norm(cross(of.points[static_cast<std::size_t>(b)] - of.points[static_cast<std::size_t>(a)],
                          of.points[static_cast<std::size_t>(c)] - of.points[static_cast<std::size_t>(a)]));
    return out;
  };
  const Real before = area_of(once);
  try {
    const std::vector<std::string> names{"fin", "wing"};
    open_thin_walls(mesh, names);
    mesh.validate();
    // A sound mesh has both sides of every wall.
    if (std::abs(area_of(mesh) - 2 * before) > 1e-9) std::abort();
  } catch (const InputError&) {
    // No such walls, a face given to both patches, at the side of the box, or walls around cells.
  }
  return 0;
}
