#include "io/mesh_builder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <span>
#include <utility>

#include "core/error.hpp"
#include "io/utf8.hpp"

namespace alphadot {
namespace {

// More stretches of cells than a message could make use of.
constexpr std::size_t most_volumes = 1000;

/// "a", "a and b", "a, b and c".
std::string listed(const std::vector<std::string>& parts) {
  std::string out;
  for (std::size_t i = 0; i < parts.size(); ++i)
    out += (i == 0 ? "" : i + 1 < parts.size() ? ", " : " and ") + parts[i];
  return out;
}

/// Whether all points lie in one plane across an axis.
bool is_plane(const std::vector<Vec3>& points) {
  for (int axis = 0; axis < 3; ++axis)
    if (std::all_of(points.begin(), points.end(),
                    [&](const Vec3& point) { return point[axis] == points.front()[axis]; }))
      return true;
  return false;
}

}  // namespace

MeshBuilder::MeshBuilder(std::string file) {
  mesh_.file = std::move(file);
}

void MeshBuilder::begin_volume(std::string_view name) {
  if (volume_starts_.size() > most_volumes) return;
  if (volume_starts_.empty() || volume_starts_.back().name != name)
    volume_starts_.push_back({std::string(name), sizes()});
}

MeshOfFile MeshBuilder::finish(const std::string& remedy) && {
  fail_without_cells(remedy);
  turn_left_handed();
  const std::size_t first_cut = mesh_.cells.size();
  cut();
  for (NamedVolume& volume : mesh_.volumes) volume.name = as_utf8(volume.name);
  make_patches();
  drop_unused_points(first_cut);
  return std::move(mesh_);
}

void MeshBuilder::fail_without_cells(const std::string& remedy) const {
  if (!mesh_.cells.empty() || !pyramids_.empty() || !prisms_.empty() || !hexahedra_.empty()) return;
  std::size_t faces = 0;
  for (const Surface& surface : surfaces_) faces += surface.triangles.size() + surface.quadrilaterals.size();
  if (faces > 0 && is_plane(mesh_.points))
    throw InputError(
        mesh_.file, 0,
        fmt::format("the mesh is two-dimensional: {} triangles and quadrilaterals in a plane, no "
                    "volume elements",
                    faces),
        "alphadot computes flows in three dimensions: extrude the mesh by one layer, with a "
        "symmetry patch on either side");
  throw InputError(mesh_.file, 0,
                   faces > 0 ? fmt::format("the mesh has no volume elements: it is the surface of a body ({} "
                                           "triangles and quadrilaterals)",
                                           faces)
                             : std::string("the mesh has no volume elements"),
                   remedy);
}

void MeshBuilder::turn_left_handed() {
  GlobalIndex turned = 0;
  is_used_.assign(mesh_.points.size(), false);
  const auto at = [&](GlobalIndex point) {
    is_used_[static_cast<std::size_t>(point)] = true;
    return mesh_.points[static_cast<std::size_t>(point)];
  };
  for (auto& [a, b, c, d] : mesh_.cells) {
    const Vec3 origin = at(a);
    if (!(dot(cross(at(b) - origin, at(c) - origin), at(d) - origin) < 0)) continue;
    std::swap(b, c);
    ++turned;
  }
  if (turned > 0)
    note(
        fmt::format("{} of {} tetrahedra were left-handed and have been turned", turned, mesh_.cells.size()));
}

/// Cuts the elements of one shape, the number of its array being `shape`, volume by volume.
template <std::size_t n>
CuttingTally MeshBuilder::cut(std::vector<std::array<GlobalIndex, n>>& elements, std::size_t shape) {
  CuttingTally total;
  const std::span all(elements);
  for (std::size_t i = 0; i < std::max<std::size_t>(volume_starts_.size(), 1); ++i) {
    const std::size_t begin = i == 0 ? 0 : volume_starts_[i].first[shape],
                      end = i + 1 < volume_starts_.size() ? volume_starts_[i + 1].first[shape] : all.size();
    if (begin == end) continue;
    if (!volume_starts_.empty())
      mesh_.volumes.push_back({volume_starts_[i].name, static_cast<GlobalIndex>(mesh_.cells.size())});
    total += cut_elements<n>(all.subspan(begin, end - begin), mesh_.points, mesh_.cells);
  }
  elements = {};
  return total;
}

void MeshBuilder::cut() {
  if (volume_starts_.size() > most_volumes) volume_starts_.clear();
  for (const VolumeStart& start : volume_starts_)
    if (mesh_.volumes.empty() || start.first[0] > static_cast<std::size_t>(mesh_.volumes.back().first_cell))
      mesh_.volumes.push_back({start.name, static_cast<GlobalIndex>(start.first[0])});
    else
      mesh_.volumes.back().name = start.name;
  std::vector<std::string> kinds;
  CuttingTally total;
  const auto add = [&](Shape shape, std::size_t array, auto& elements) {
    if (elements.empty()) return;
    const CuttingTally tally = cut(elements, array);
    kinds.push_back(fmt::format("{} {}", tally.elements, plural(shape)));
    total += tally;
  };
  add(Shape::hexahedron, 3, hexahedra_);
  add(Shape::prism, 2, prisms_);
  add(Shape::pyramid, 1, pyramids_);
  if (curved_ > 0)
    note(
        fmt::format("{} volume elements of higher order: their corners are used, the curvature of their "
                    "sides is lost",
                    curved_));
  if (kinds.empty()) return;
  const auto mean = [](const CuttingTally::Quality& quality, GlobalIndex count) {
    return quality.sum / static_cast<Real>(std::max<GlobalIndex>(count, 1));
  };
  note(fmt::format(
      "{} cut into {} tetrahedra; scaled Jacobian (1: ideal) {:.3g} at least and {:.3g} in the mean before, "
      "{:.3g} and {:.3g} after",
      listed(kinds), total.tetrahedra, total.before.least,
      mean(total.before, total.elements - total.collapsed), total.after.least,
      mean(total.after, total.tetrahedra)));
  if (total.with_inner_point > 0)
    note(fmt::format("{} warped elements were cut about a new point inside", total.with_inner_point));
  if (total.left_handed > 0)
    note(fmt::format("{} of these elements were left-handed and have been turned", total.left_handed));
  if (total.collapsed > 0)
    note(fmt::format("{} elements were collapsed to nothing and have been left out", total.collapsed));
  if (total.thin > 0)
    note(fmt::format(
        "{} of these elements are more than 50 times as long as thick, as for a boundary layer: the Euler "
        "equations have none, and thin cells add to cost and error; mesh without such layers",
        total.thin));
}

void MeshBuilder::make_patches() {
  GlobalIndex quadrilaterals = 0, triangles = 0;
  for (Surface& surface : surfaces_) {
    Patch& patch = mesh_.patches.emplace_back(Patch{as_utf8(surface.name), std::move(surface.triangles)});
    quadrilaterals += static_cast<GlobalIndex>(surface.quadrilaterals.size());
    patch.triangles.reserve(patch.triangles.size() + 2 * surface.quadrilaterals.size());
    for (const auto& quadrilateral : surface.quadrilaterals)
      for_each_triangle(quadrilateral, [&](const std::array<GlobalIndex, 3>& triangle) {
        patch.triangles.push_back(triangle);
        ++triangles;
      });
    surface.quadrilaterals = {};
  }
  if (quadrilaterals > 0)
    note(fmt::format("{} boundary quadrilaterals cut into {} triangles", quadrilaterals, triangles));
}

void MeshBuilder::drop_unused_points(std::size_t first_cut) {
  const auto for_each_use = [this](std::size_t first_cell, auto&& visit) {
    for (std::size_t cell = first_cell; cell < mesh_.cells.size(); ++cell)
      for (GlobalIndex& point : mesh_.cells[cell]) visit(point);
    for (Patch& patch : mesh_.patches)
      for (auto& triangle : patch.triangles)
        for (GlobalIndex& point : triangle) visit(point);
  };
  is_used_.resize(mesh_.points.size(), false);
  for_each_use(first_cut, [&](GlobalIndex point) { is_used_[static_cast<std::size_t>(point)] = true; });
  if (std::find(is_used_.begin(), is_used_.end(), false) == is_used_.end()) return;

  std::vector<GlobalIndex> new_id(mesh_.points.size());
  std::size_t kept = 0;
  for (std::size_t point = 0; point < is_used_.size(); ++point) {
    if (!is_used_[point]) continue;
    new_id[point] = static_cast<GlobalIndex>(kept);
    mesh_.points[kept++] = mesh_.points[point];
  }
  mesh_.points.resize(kept);
  for_each_use(0, [&](GlobalIndex& point) { point = new_id[static_cast<std::size_t>(point)]; });
}

}  // namespace alphadot
