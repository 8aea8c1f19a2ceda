#include "io/mesh_builder.hpp"

#include <algorithm>
#include <utility>

#include "core/error.hpp"

namespace alphadot {
namespace {

// More names than any mesh has: such a file numbers something else in the place of its boundaries.
constexpr std::size_t most_patches = 10'000;
// Of a patch with its names and lists, before it has triangles.
constexpr std::size_t patch_bytes = 256;

}  // namespace

MeshBuilder::MeshBuilder(std::string file) {
  mesh_.file = std::move(file);
}

Patch& MeshBuilder::patch(std::string_view name, const Scanner& scanner) {
  const auto found = patches_.find(name);
  if (found != patches_.end()) return mesh_.patches[found->second];
  const std::size_t most = std::min(most_patches, largest_array(scanner) / patch_bytes);
  if (mesh_.patches.size() == most)
    scanner.fail("more than " + std::to_string(most) + " boundary patches",
                 "check that boundaries, not single triangles, are numbered");
  patches_.emplace(name, mesh_.patches.size());
  return mesh_.patches.emplace_back(Patch{std::string(name), {}});
}

void MeshBuilder::check_refused(const Scanner& scanner) const {
  if (refused_.empty()) return;
  std::string list;
  for (const auto& [plural, count] : refused_)
    list += (list.empty() ? "" : ", ") + std::to_string(count) + " " + std::string(plural);
  scanner.fail("the mesh holds " + list + ", but only linear tetrahedra and triangles can be used",
               "mesh the volume with first-order tetrahedra only");
}

Mesh MeshBuilder::finish(const std::string& remedy) && {
  if (mesh_.cells.empty()) throw InputError(mesh_.file, 0, "the mesh has no tetrahedra", remedy);
  drop_unused_points();
  return std::move(mesh_);
}

void MeshBuilder::drop_unused_points() {
  const auto for_each_use = [this](auto&& visit) {
    for (auto& cell : mesh_.cells)
      for (GlobalIndex& point : cell) visit(point);
    for (Patch& patch : mesh_.patches)
      for (auto& triangle : patch.triangles)
        for (GlobalIndex& point : triangle) visit(point);
  };
  std::vector<bool> used(mesh_.points.size(), false);
  for_each_use([&](GlobalIndex point) { used[static_cast<std::size_t>(point)] = true; });
  if (std::find(used.begin(), used.end(), false) == used.end()) return;

  std::vector<GlobalIndex> new_id(mesh_.points.size());
  std::size_t kept = 0;
  for (std::size_t point = 0; point < used.size(); ++point) {
    if (!used[point]) continue;
    new_id[point] = static_cast<GlobalIndex>(kept);
    mesh_.points[kept++] = mesh_.points[point];
  }
  mesh_.points.resize(kept);
  for_each_use([&](GlobalIndex& point) { point = new_id[static_cast<std::size_t>(point)]; });
}

}  // namespace alphadot
