#include "partition/mesh.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <xxhash.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <memory>
#include <set>
#include <span>
#include <utility>

#include "core/error.hpp"
#include "partition/box.hpp"
#include "partition/disjoint_sets.hpp"
#include "partition/face_matching.hpp"
#include "partition/geometry.hpp"

namespace alphadot {

namespace {

/// How often a defect was met, and the lowest id that has it.
struct Tally {
  GlobalIndex count = 0, first = 0;
  void add(GlobalIndex id) {
    if (count++ == 0 || id < first) first = id;
  }
};

template <std::size_t n>
bool in_range(const std::array<GlobalIndex, n>& ids, GlobalIndex points) {
  return std::all_of(ids.begin(), ids.end(), [&](GlobalIndex id) { return id >= 0 && id < points; });
}

template <std::size_t n>
bool distinct(std::array<GlobalIndex, n> ids) {
  std::sort(ids.begin(), ids.end());
  return std::adjacent_find(ids.begin(), ids.end()) == ids.end();
}

std::string text(const Vec3& at) {
  return fmt::format("({:.6g}, {:.6g}, {:.6g})", at.x, at.y, at.z);
}

/// Gathers the checks' findings.
class Validator {
 public:
  explicit Validator(const Mesh& mesh) : mesh_(mesh), triangles_(mesh.boundary_triangles()) {}

  void run() {
    check_sizes();
    stop_if_problems();  // what follows indexes with the ids
    check_points();
    check_ids();
    stop_if_problems();
    check_volumes();
    check_faces();
    stop_if_problems();
  }

 private:
  void check_sizes() {
    const auto cells = static_cast<GlobalIndex>(mesh_.cells.size());
    if (cells == 0) problem("the mesh has no tetrahedra", "export the volume mesh, not only its surface");
    if (std::max(cells, static_cast<GlobalIndex>(triangles_.size())) > max_cells_for_faces)
      problem(fmt::format("{} cells and {} boundary triangles are more than faces can be numbered for", cells,
                          triangles_.size()),
              fmt::format("use at most {} of each", max_cells_for_faces));
  }

  void check_points() {
    Tally tally;
    for (std::size_t i = 0; i < mesh_.points.size(); ++i) {
      const Vec3& p = mesh_.points[i];
      if (!(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z)))
        tally.add(static_cast<GlobalIndex>(i));
    }
    if (tally.count > 0)
      problem(fmt::format("point {} at {} is not finite ({} such points)", tally.first + 1,
                          text(mesh_.points[tally.first]), tally.count),
              "write the mesh again; the file may be damaged");
  }

  void check_ids() {
    check_ids_of("cell", mesh_.cells);
    check_ids_of("boundary triangle", triangles_);
  }

  template <std::size_t n>
  void check_ids_of(const char* kind, const std::vector<std::array<GlobalIndex, n>>& elements) {
    const auto points = static_cast<GlobalIndex>(mesh_.points.size());
    Tally out_of_range, repeated;
    for (std::size_t i = 0; i < elements.size(); ++i) {
      if (!in_range(elements[i], points))
        out_of_range.add(static_cast<GlobalIndex>(i));
      else if (!distinct(elements[i]))
        repeated.add(static_cast<GlobalIndex>(i));
    }
    const auto listed = [&](const Tally& tally) {
      std::string out;
      for (const GlobalIndex id : elements[tally.first])
        out += fmt::format("{}{}", out.empty() ? "" : " ", id + 1);
      return out;
    };
    if (out_of_range.count > 0)
      problem(fmt::format("{} {} has the points {}, but there are points 1 to {} only ({} such {}s)", kind,
                          out_of_range.first + 1, listed(out_of_range), points, out_of_range.count, kind),
              "write the mesh again; the file may be damaged or cut short");
    if (repeated.count > 0)
      problem(fmt::format("{} {} has the points {}, of which two are the same ({} such {}s)", kind,
                          repeated.first + 1, listed(repeated), repeated.count, kind),
              "remove collapsed elements in the mesh generator");
  }

  void check_volumes() {
    Tally tally;
    for (std::size_t i = 0; i < mesh_.cells.size(); ++i)
      if (!(metrics(i).volume > 0)) tally.add(static_cast<GlobalIndex>(i));
    report_cells(tally, "has no positive volume",
                 "orient every tetrahedron so that (p1-p0) x (p2-p0) . (p3-p0) > 0, and mend flat ones");
  }

  void check_faces() {
    const auto cell_sides = static_cast<Index>(4 * mesh_.cells.size());
    Tally crowded, overlapping, twice_covered, covered_inside, loose;
    std::string_view also_covering;  // patch of the other triangle of the first such case
    std::vector<Index> bare;
    DisjointSets joined(mesh_.cells.size());      // through faces that no triangle covers
    std::vector<std::pair<Index, Index>> beside;  // cells on either side of inner triangles
    for_each_face<GlobalIndex>(
        mesh_.cells, triangles_, mesh_.points.size(), [&](std::span<const Index> sides) {
          const auto cells =
              std::find_if(sides.begin(), sides.end(), [&](Index s) { return s >= cell_sides; }) -
              sides.begin();
          const auto triangles = static_cast<std::ptrdiff_t>(sides.size()) - cells;
          const GlobalIndex cell = sides.front() / 4;
          const GlobalIndex triangle = sides.back() - cell_sides;
          if (cells > 2) crowded.add(cell);
          // An inverted cell has been reported as such: its wrong side is no second defect.
          if (cells == 2 && !opposed(sides[0], sides[1]) && metrics(sides[0] / 4).volume > 0 &&
              metrics(sides[1] / 4).volume > 0)
            overlapping.add(cell);
          if (cells == 1 && triangles == 0) bare.push_back(sides.front() / 4);
          if (cells > 0 && triangles > 1) {
            if (twice_covered.count == 0)
              also_covering = place_of(sides[sides.size() - 2] - cell_sides).first->name;
            twice_covered.add(triangle);
          }
          if (cells == 2 && triangles == 0) joined.join(sides[0] / 4, sides[1] / 4);
          if (cells > 1 && triangles == 1) {
            covered_inside.add(triangle);
            beside.emplace_back(sides[0] / 4, sides[1] / 4);
          }
          if (cells == 0) loose.add(triangle);
        });
    const std::vector<Part> parts = parts_beside(beside, joined);
    report_cells(crowded, "shares a face with two or more other cells",
                 "remove duplicate or overlapping cells");
    report_cells(overlapping, "lies on the same side of a face as its neighbour", "remove overlapping cells");
    report_bare(bare, parts, joined);
    report_triangles(
        twice_covered, fmt::format("covers a face that a triangle of patch \"{}\" covers too", also_covering),
        "put each surface in one patch only, and once; of a body that has no thickness mesh.thin "
        "makes both sides");
    report_inner_surface(covered_inside, parts);
    report_triangles(loose, "is not a face of any cell",
                     "leave surfaces without a volume next to them out of the patches");
  }

  /// Cells that are joined to each other through faces without a triangle.
  struct Part {
    Index root = 0;
    GlobalIndex cells = 0;
    Box box = empty_box();
    std::set<std::string_view> volumes;  ///< names of the volumes that its cells are of
    /// Whether it lies within another part, as the inside of a body does.
    bool is_inside = false;
  };

  /// The parts that inner triangles have on their two sides, the largest first; none when every triangle has
  /// the same part on both.
  std::vector<Part> parts_beside(const std::vector<std::pair<Index, Index>>& beside,
                                 DisjointSets& joined) const {
    std::vector<Part> parts;
    std::vector<Index> part_of_root(mesh_.cells.size() * !beside.empty(), -1);
    for (const auto& [a, b] : beside)
      if (joined.root(a) != joined.root(b))
        for (const Index cell : {a, b}) {
          const Index root = joined.root(cell);
          if (part_of_root[root] >= 0) continue;
          part_of_root[root] = static_cast<Index>(parts.size());
          parts.emplace_back().root = root;
        }
    if (parts.empty()) return parts;
    for (std::size_t cell = 0; cell < mesh_.cells.size(); ++cell) {
      const Index number = part_of_root[joined.root(static_cast<Index>(cell))];
      if (number < 0) continue;
      Part& part = parts[number];
      ++part.cells;
      for (const GlobalIndex point : mesh_.cells[cell]) extend(part.box, mesh_.points[point]);
      const std::string_view volume = mesh_.volume_of(static_cast<GlobalIndex>(cell));
      if (!volume.empty()) part.volumes.insert(volume);
    }
    std::ranges::stable_sort(parts, [](const Part& a, const Part& b) { return a.cells > b.cells; });
    for (Part& part : parts)
      part.is_inside = std::ranges::any_of(parts, [&](const Part& other) {
        return &other != &part && contains(other.box, part.box) && !contains(part.box, other.box);
      });
    return parts;
  }

  /// A wall may only be missing because the inside of the body is meshed, which is told elsewhere.
  void report_bare(std::span<const Index> bare, std::span<const Part> parts, DisjointSets& joined) {
    Tally tally;
    for (const Index cell : bare)
      if (std::ranges::none_of(parts, [root = joined.root(cell)](const Part& part) {
            return part.is_inside && part.root == root;
          }))
        tally.add(cell);
    report_cells(
        tally, "has a face with neither a second cell nor a boundary triangle",
        "put every surface of the volume in a physical group (Gmsh), marker (SU2) or boundary condition "
        "(CGNS), and merge double points");
  }

  /// 'volume "air" (120 cells from ... to ...)', or 'the 120 cells from ... to ...' where it has no name.
  static std::string described(const Part& part) {
    const std::string extent =
        fmt::format("{} cells from {} to {}", part.cells, text(part.box.lower), text(part.box.upper));
    if (part.volumes.empty()) return "the " + extent;
    return fmt::format("volume{} \"{}\" ({})", part.volumes.size() > 1 ? "s" : "",
                       fmt::join(part.volumes, "\", \""), extent);
  }

  /// A surface inside the mesh either has cells of one flow on both sides, or parts it: then the mesh goes on
  /// inside the body.
  void report_inner_surface(const Tally& tally, std::span<const Part> parts) {
    if (parts.empty())
      return report_triangles(
          tally, "lies between two cells",
          "a body that has no thickness becomes a wall with two sides when mesh.thin lists its patch; leave "
          "surfaces that are no bodies out of the patches");
    const auto inside = std::ranges::find_if(parts, &Part::is_inside);
    std::string remedy;
    if (inside == parts.end()) {
      remedy =
          "leave the one that is not the flow out of the mesh, or, where both are, end the surface before it "
          "parts them";
    } else {
      // A person who takes out one body should not have to come again for the next.
      constexpr std::ptrdiff_t most = 5;
      std::ptrdiff_t listed = 0;
      for (const Part& part : parts)
        if (part.is_inside && listed++ < most)
          remedy += (remedy.empty() ? "leave out of the mesh what is the inside of a body: " : ", ") +
                    described(part);
      if (listed > most) remedy += fmt::format(" and {} more", listed - most);
    }
    const Part& other = inside == parts.end() ? parts[1] : *inside;
    const Part& flow = parts[0].root == other.root ? parts[1] : parts[0];
    report_triangles(
        tally,
        fmt::format("lies between two cells: it is a wall between {} and {}", described(flow),
                    described(other)),
        remedy + " (in Gmsh, make a Physical Volume of the flow alone); the surface stays a patch");
  }

  /// True when the sides are traversed in opposite senses, i.e. their cells lie on opposite sides of the
  /// face.
  bool opposed(Index side_a, Index side_b) const {
    const auto a = side_points<GlobalIndex>(mesh_.cells, side_a);
    const auto b = side_points<GlobalIndex>(mesh_.cells, side_b);
    const auto start = static_cast<std::size_t>(std::find(b.begin(), b.end(), a[0]) - b.begin());
    return b[(start + 1) % 3] == a[2];
  }

  TetrahedronMetrics metrics(std::size_t cell) const {
    const auto& ids = mesh_.cells[cell];
    std::array<Vec3, 4> points;
    for (std::size_t i = 0; i < 4; ++i) points[i] = mesh_.points[ids[i]];
    return tetrahedron_metrics(points, ids);
  }

  void report_cells(const Tally& tally, const char* what, const char* remedy) {
    if (tally.count == 0) return;
    const auto [volume, center] = metrics(static_cast<std::size_t>(tally.first));
    problem(fmt::format("cell {} at {}, of volume {:.6g}, {} ({} such cases)", tally.first + 1, text(center),
                        volume, what, tally.count),
            remedy);
  }

  void report_triangles(const Tally& tally, const std::string& what, const std::string& remedy) {
    if (tally.count == 0) return;
    const auto [patch, place] = place_of(tally.first);
    Vec3 center;
    for (const GlobalIndex id : triangles_[tally.first]) center += 1.0 / 3 * mesh_.points[id];
    problem(fmt::format("triangle {} of patch \"{}\" at {} {} ({} such cases)", place + 1, patch->name,
                        text(center), what, tally.count),
            remedy);
  }

  /// The patch of a triangle and its place within it.
  std::pair<const Patch*, GlobalIndex> place_of(GlobalIndex triangle) const {
    auto patch = mesh_.patches.begin();
    for (; triangle >= static_cast<GlobalIndex>(patch->triangles.size()); ++patch)
      triangle -= static_cast<GlobalIndex>(patch->triangles.size());
    return {&*patch, triangle};
  }

  void problem(std::string what, std::string remedy) {
    problems_.push_back({mesh_.file, 0, std::move(what), std::move(remedy)});
  }

  void stop_if_problems() {
    if (!problems_.empty()) throw InputError(std::move(problems_));
  }

  const Mesh& mesh_;
  const std::vector<std::array<GlobalIndex, 3>> triangles_;
  std::vector<Problem> problems_;
};

}  // namespace

void Mesh::validate() const {
  Validator(*this).run();
}

std::string_view Mesh::volume_of(GlobalIndex cell) const {
  const auto next = std::ranges::upper_bound(volumes, cell, {}, &NamedVolume::first_cell);
  return next == volumes.begin() ? std::string_view{} : std::string_view(std::prev(next)->name);
}

std::vector<std::array<GlobalIndex, 3>> Mesh::boundary_triangles() const {
  std::vector<std::array<GlobalIndex, 3>> triangles;
  for (const Patch& patch : patches)
    triangles.insert(triangles.end(), patch.triangles.begin(), patch.triangles.end());
  return triangles;
}

std::string Mesh::hash() const {
  const std::unique_ptr<XXH64_state_t, decltype(&XXH64_freeState)> state(XXH64_createState(),
                                                                         &XXH64_freeState);
  XXH64_reset(state.get(), 0);
  // Each array after its length, so that no two meshes run together to the same bytes.
  const auto add = [&](const auto& array) {
    const auto length = static_cast<GlobalIndex>(array.size());
    XXH64_update(state.get(), &length, sizeof(length));
    if (length > 0) XXH64_update(state.get(), array.data(), array.size() * sizeof(array[0]));
  };
  add(points);
  add(cells);
  for (const auto& patch : patches) {
    add(patch.name);
    add(patch.triangles);
  }
  return fmt::format("{:016x}", XXH64_digest(state.get()));
}

}  // namespace alphadot
