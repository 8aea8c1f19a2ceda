#include "partition/rank_mesh.hpp"

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <span>
#include <utility>

#include "core/error.hpp"
#include "partition/adjacency.hpp"
#include "partition/point_table.hpp"
#include "partition/slabs.hpp"

namespace alphadot {

namespace {

/// A cell on its way to a rank that has a point in common with it.
struct Ghost {
  GlobalIndex id;
  std::array<GlobalIndex, 4> points;
  std::array<Vec3, 4> at;
};

struct Ghosts {
  std::vector<Ghost> cells;  ///< by id
  std::vector<int> owner;
};

class Gatherer {
 public:
  Gatherer(MeshPart part, const Communicator& comm) : part_(std::move(part)), comm_(comm) {}

  RankMesh gather() {
    comm_.on_all([&] { check_ids(); });
    if (!part_.cells.empty()) table_.ids = used_points(part_.cells);
    const Slabs slabs(table_.ids, part_.global_points, comm_);
    table_.at.resize(table_.ids.size());
    slabs.from_slab<Vec3>(part_.points, table_.at);
    release(part_.points);
    const Ghosts ghosts = exchange(slabs.sharings());
    add_points_of(ghosts);
    RankMesh rank_mesh;
    comm_.on_all([&] { rank_mesh = assemble(ghosts); });
    return rank_mesh;
  }

 private:
  template <class T>
  static void release(std::vector<T>& values) {
    std::vector<T>().swap(values);
  }

  void check_ids() const {
    const auto check = [&](const auto& ids) {
      for (const GlobalIndex id : ids)
        if (id < 0 || id >= part_.global_points)
          throw InputError(part_.file, 0,
                           "a cell or triangle has the point " + std::to_string(id) + ", but there are " +
                               std::to_string(part_.global_points) + " points",
                           "make the file anew; it is damaged");
    };
    for (const auto& cell : part_.cells) check(cell);
    for (const auto& triangle : part_.triangles) check(triangle.points);
  }

  /// The cells of other ranks around the points shared with them.
  Ghosts exchange(const std::vector<Slabs::Sharing>& sharings) const {
    const Adjacency ranks_at =
        collect_rows(static_cast<Index>(table_.ids.size()), static_cast<Index>(sharings.size()),
                     [&](Index sharing) { return std::array{sharings[sharing].position}; });
    struct Sent {
      Ghost ghost;
      int to;
    };
    std::vector<Sent> sent;
    std::vector<int> ranks;
    for (std::size_t i = 0; i < part_.cells.size(); ++i) {
      const auto& points = part_.cells[i];
      std::array<std::size_t, 4> place;
      ranks.clear();
      for (std::size_t corner = 0; corner < 4; ++corner) {
        place[corner] = table_.find(points[corner]);
        for (const Index sharing : ranks_at[static_cast<Index>(place[corner])])
          ranks.push_back(sharings[sharing].rank);
      }
      if (ranks.empty()) continue;
      std::sort(ranks.begin(), ranks.end());
      ranks.erase(std::unique(ranks.begin(), ranks.end()), ranks.end());
      for (const int rank : ranks)
        sent.push_back(
            {{part_.cell_ids[i],
              points,
              {table_.at[place[0]], table_.at[place[1]], table_.at[place[2]], table_.at[place[3]]}},
             rank});
    }
    const auto received = deliver_to<Sent>(
        sent, [](const Sent& item) { return item.to; }, comm_);
    const auto senders = received.senders();

    std::vector<Index> order(received.items.size());
    std::iota(order.begin(), order.end(), 0);
    std::sort(order.begin(), order.end(),
              [&](Index a, Index b) { return received.items[a].ghost.id < received.items[b].ghost.id; });
    Ghosts out;
    for (const Index i : order) {
      out.cells.push_back(received.items[i].ghost);
      out.owner.push_back(senders[i]);
    }
    return out;
  }

  /// Puts the points that only ghosts have into the table.
  void add_points_of(const Ghosts& ghosts) {
    std::vector<std::pair<GlobalIndex, Vec3>> more;
    for (const auto& ghost : ghosts.cells)
      for (std::size_t corner = 0; corner < 4; ++corner)
        if (table_.find(ghost.points[corner]) == table_.ids.size())
          more.emplace_back(ghost.points[corner], ghost.at[corner]);
    std::sort(more.begin(), more.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
    more.erase(std::unique(more.begin(), more.end(),
                           [](const auto& a, const auto& b) { return a.first == b.first; }),
               more.end());
    PointTable all;
    all.ids.reserve(table_.ids.size() + more.size());
    all.at.reserve(all.ids.capacity());
    auto next = more.begin();
    for (std::size_t i = 0; i <= table_.ids.size(); ++i) {
      for (; next != more.end() && (i == table_.ids.size() || next->first < table_.ids[i]); ++next) {
        all.ids.push_back(next->first);
        all.at.push_back(next->second);
      }
      if (i == table_.ids.size()) break;
      all.ids.push_back(table_.ids[i]);
      all.at.push_back(table_.at[i]);
    }
    table_ = std::move(all);
  }

  RankMesh assemble(const Ghosts& ghosts) {
    RankMesh rank_mesh;
    rank_mesh.global_cells = part_.global_cells;
    rank_mesh.global_points = part_.global_points;
    rank_mesh.patch_names = std::move(part_.patch_names);
    rank_mesh.cell_ids = std::move(part_.cell_ids);
    rank_mesh.ghost_owner = ghosts.owner;
    std::vector<Index> number(table_.ids.size(), -1);
    const auto add_cell = [&](const std::array<GlobalIndex, 4>& points) {
      auto& local = rank_mesh.cell_points.emplace_back();
      for (std::size_t corner = 0; corner < 4; ++corner) {
        const std::size_t place = table_.find(points[corner]);
        if (number[place] < 0) {
          number[place] = static_cast<Index>(rank_mesh.point_ids.size());
          rank_mesh.point_ids.push_back(table_.ids[place]);
          rank_mesh.points.push_back(table_.at[place]);
        }
        local[corner] = number[place];
      }
    };
    rank_mesh.cell_points.reserve(part_.cells.size() + ghosts.cells.size());
    rank_mesh.point_ids.reserve(table_.ids.size());
    rank_mesh.points.reserve(table_.ids.size());
    for (const auto& points : part_.cells) add_cell(points);
    for (const auto& ghost : ghosts.cells) {
      rank_mesh.cell_ids.push_back(ghost.id);
      add_cell(ghost.points);
    }
    for (const auto& triangle : part_.triangles) {
      auto& local = rank_mesh.triangles.emplace_back();
      for (std::size_t corner = 0; corner < 3; ++corner) {
        const std::size_t place = table_.find(triangle.points[corner]);
        if (place == number.size())
          throw InputError(part_.file, 0,
                           "boundary triangle " + std::to_string(triangle.id + 1) + " is not on its cell",
                           "make the file anew; it is damaged");
        local[corner] = number[place];
      }
      rank_mesh.triangle_ids.push_back(triangle.id);
      rank_mesh.triangle_patch.push_back(static_cast<Index>(triangle.patch));
    }
    return rank_mesh;
  }

  MeshPart part_;
  const Communicator& comm_;
  PointTable table_;
};

}  // namespace

RankMesh gather_rank_mesh(MeshPart part, const Communicator& comm) {
  return Gatherer(std::move(part), comm).gather();
}

}  // namespace alphadot
