#include "partition/refine.hpp"

#include <algorithm>
#include <compare>
#include <cstddef>
#include <utility>
#include <vector>

#include "partition/point_table.hpp"
#include "partition/slabs.hpp"

namespace alphadot {

namespace {

struct Edge {
  GlobalIndex a, b;  // a < b
  auto operator<=>(const Edge&) const = default;
};

Edge edge(GlobalIndex a, GlobalIndex b) {
  return a < b ? Edge{a, b} : Edge{b, a};
}

class Refiner {
 public:
  Refiner(MeshPart part, const Communicator& comm) : part_(std::move(part)), comm_(comm) {}

  MeshPart refined() {
    find_points();
    find_edges();
    number_edges();
    MeshPart out;
    out.file = part_.file;
    out.patch_names = part_.patch_names;
    out.global_cells = 8 * part_.global_cells;
    out.global_points = part_.global_points + global_edges_;
    out.global_triangles = 4 * part_.global_triangles;
    split_cells(out);
    split_triangles(out);
    out.points = points_by_slabs(out.global_points);
    return out;
  }

 private:
  void find_points() {
    if (!part_.cells.empty()) table_.ids = used_points(part_.cells);
    const Slabs slabs(table_.ids, part_.global_points, comm_);
    first_point_ = slabs.begin();
    table_.at.resize(table_.ids.size());
    slabs.from_slab<Vec3>(part_.points, table_.at);
  }

  void find_edges() {
    edges_.reserve(6 * part_.cells.size());
    for (const auto& c : part_.cells)
      for (std::size_t i = 0; i < 4; ++i)
        for (std::size_t j = i + 1; j < 4; ++j) edges_.push_back(edge(c[i], c[j]));
    std::sort(edges_.begin(), edges_.end());
    edges_.erase(std::unique(edges_.begin(), edges_.end()), edges_.end());
  }

  /// The rank that holds the first point of an edge numbers it.
  void number_edges() {
    const EqualSlabs slabs(part_.global_points, comm_.size());
    // Edges ascend, and so do the ranks that hold their first points: they are in the order of the ranks.
    std::vector<int> counts(static_cast<std::size_t>(comm_.size()), 0);
    for (const Edge& e : edges_) ++counts[static_cast<std::size_t>(slabs.rank_of(e.a))];
    const auto asked = deliver<Edge>(edges_, counts, comm_);
    auto held = asked.items;
    std::sort(held.begin(), held.end());
    held.erase(std::unique(held.begin(), held.end()), held.end());

    const auto count = static_cast<GlobalIndex>(held.size());
    GlobalIndex before = 0;
    MPI_Exscan(&count, &before, 1, MPI_INT64_T, MPI_SUM, comm_.handle());
    global_edges_ = comm_.sum(count);
    std::vector<GlobalIndex> answers;
    answers.reserve(asked.items.size());
    for (const Edge& e : asked.items)
      answers.push_back(part_.global_points + before +
                        (std::lower_bound(held.begin(), held.end(), e) - held.begin()));
    middles_ = deliver<GlobalIndex>(answers, asked.counts, comm_).items;
  }

  GlobalIndex middle(GlobalIndex a, GlobalIndex b) const {
    const auto found = std::lower_bound(edges_.begin(), edges_.end(), edge(a, b));
    return middles_[static_cast<std::size_t>(found - edges_.begin())];
  }
  Vec3 place(const Edge& e) const { return 0.5 * (table_[e.a] + table_[e.b]); }

  void split_cells(MeshPart& out) const {
    out.cell_ids.reserve(8 * part_.cells.size());
    out.cells.reserve(8 * part_.cells.size());
    for (std::size_t i = 0; i < part_.cells.size(); ++i) {
      const auto& [a, b, c, d] = part_.cells[i];
      const GlobalIndex ab = middle(a, b), ac = middle(a, c), ad = middle(a, d), bc = middle(b, c),
                        bd = middle(b, d), cd = middle(c, d);
      const auto add = [&](GlobalIndex p, GlobalIndex q, GlobalIndex r, GlobalIndex s) {
        out.cell_ids.push_back(8 * part_.cell_ids[i] + static_cast<GlobalIndex>(out.cells.size() % 8));
        out.cells.push_back({p, q, r, s});
      };
      add(a, ab, ac, ad);
      add(ab, b, bc, bd);
      add(ac, bc, c, cd);
      add(ad, bd, cd, d);
      // Four tetrahedra about the diagonal from `foot` to `head`, each with an edge of the ring round it.
      const auto ring = [&](GlobalIndex foot, GlobalIndex head, const std::array<GlobalIndex, 4>& round) {
        for (std::size_t k = 0; k < 4; ++k) add(foot, head, round[k], round[(k + 1) % 4]);
      };
      const Real ab_cd = length(edge(a, b), edge(c, d)), ac_bd = length(edge(a, c), edge(b, d)),
                 ad_bc = length(edge(a, d), edge(b, c));
      if (ab_cd <= ac_bd && ab_cd <= ad_bc)
        ring(ab, cd, {ac, ad, bd, bc});
      else if (ac_bd <= ad_bc)
        ring(ac, bd, {ad, ab, bc, cd});
      else
        ring(ad, bc, {ab, ac, cd, bd});
    }
  }

  /// Between the middles of two edges.
  Real length(const Edge& e, const Edge& f) const { return norm(place(e) - place(f)); }

  void split_triangles(MeshPart& out) const {
    out.triangles.reserve(4 * part_.triangles.size());
    for (const auto& triangle : part_.triangles) {
      const auto& [a, b, c] = triangle.points;
      const GlobalIndex ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      GlobalIndex id = 4 * triangle.id;
      for (const auto& points :
           {std::array{a, ab, ca}, std::array{ab, b, bc}, std::array{ca, bc, c}, std::array{ab, bc, ca}})
        out.triangles.push_back({points, id++, triangle.patch});
    }
  }

  /// Old points and middles of edges, in the slabs of the larger mesh.
  std::vector<Vec3> points_by_slabs(GlobalIndex total) {
    std::vector<GlobalIndex> ids = middles_;
    std::vector<Vec3> at;
    at.reserve(edges_.size() + part_.points.size());
    for (const Edge& e : edges_) at.push_back(place(e));
    for (std::size_t i = 0; i < part_.points.size(); ++i) {
      ids.push_back(first_point_ + static_cast<GlobalIndex>(i));
      at.push_back(part_.points[i]);
    }
    return Slabs(ids, total, comm_).to_slab<Vec3>(at);
  }

  MeshPart part_;
  const Communicator& comm_;
  PointTable table_;
  std::vector<Edge> edges_;           // of this rank's cells, ascending
  std::vector<GlobalIndex> middles_;  // [edges_] global point ids
  GlobalIndex first_point_ = 0, global_edges_ = 0;
};

}  // namespace

MeshPart refine(MeshPart part, const Communicator& comm) {
  return Refiner(std::move(part), comm).refined();
}

}  // namespace alphadot
