#include "partition/share.hpp"

#include <mpi.h>

#include <algorithm>
#include <cstddef>
#include <span>

#include "partition/adjacency.hpp"

namespace alphadot {

namespace {

/// Cuts shares out of the mesh. Holds flat arrays of 4 bytes a cell, 8 a point and 16 a boundary triangle,
/// and the cells around the points where parts meet.
class Cutter {
 public:
  Cutter(const Mesh& mesh, const std::vector<int>& owner, int ranks)
      : mesh_(mesh), owner_(owner), local_point_(mesh.points.size(), -1) {
    const auto cells = static_cast<Index>(mesh.cells.size());
    rank_cells_ = collect_rows(ranks, cells, [&](Index cell) { return std::array{owner_of(cell)}; });
    find_shared_points();
    shared_point_cells_ = collect_rows(shared_points_, cells, [&](Index cell) {
      auto points = mesh_.cells[cell];
      for (auto& point : points) point = shared_number(point);
      return points;
    });
    for (std::size_t i = 0; i < mesh.patches.size(); ++i)
      for (const auto& triangle : mesh.patches[i].triangles) {
        triangles_.push_back(&triangle);
        triangle_patch_.push_back(static_cast<Index>(i));
      }
    rank_triangles_ = collect_rows(ranks, static_cast<Index>(triangles_.size()), [&](Index triangle) {
      return std::array{owner_of(*triangles_[triangle])};
    });
  }

  Share cut(int rank) {
    Share share;
    for (const Index cell : rank_cells_[rank]) add_cell(share, cell);

    std::vector<Index> ghosts;
    for (const GlobalIndex point : share.point_ids)
      if (const Index number = shared_number(point); number >= 0)
        for (const Index cell : shared_point_cells_[number])
          if (owner_of(cell) != rank) ghosts.push_back(cell);
    std::sort(ghosts.begin(), ghosts.end());
    ghosts.erase(std::unique(ghosts.begin(), ghosts.end()), ghosts.end());
    for (const Index cell : ghosts) {
      add_cell(share, cell);
      share.ghost_owner.push_back(owner_of(cell));
    }

    for (const Index triangle : rank_triangles_[rank]) {
      auto& points = share.triangles.emplace_back();
      for (std::size_t i = 0; i < 3; ++i) points[i] = local_point_[(*triangles_[triangle])[i]];
      share.triangle_ids.push_back(triangle);
      share.triangle_patch.push_back(triangle_patch_[triangle]);
    }

    for (const GlobalIndex point : share.point_ids) {
      share.points.push_back(mesh_.points[point]);
      local_point_[point] = -1;
    }
    return share;
  }

 private:
  // In point_owner_: ranks are >= 0, and the points where parts meet are numbered downward from -2.
  static constexpr int unused = -1;

  int owner_of(Index cell) const { return owner_[cell]; }

  Index shared_number(GlobalIndex point) const { return unused - 1 - point_owner_[point]; }

  void find_shared_points() {
    point_owner_.assign(mesh_.points.size(), unused);
    for (std::size_t cell = 0; cell < owner_.size(); ++cell)
      for (const GlobalIndex point : mesh_.cells[cell]) {
        int& owner = point_owner_[point];
        if (owner == unused)
          owner = owner_[cell];
        else if (owner > unused && owner != owner_[cell])
          owner = unused - 1 - shared_points_++;
      }
  }

  /// The owner of the cell behind a boundary triangle.
  int owner_of(const std::array<GlobalIndex, 3>& triangle) const {
    for (const GlobalIndex point : triangle)
      if (const int owner = point_owner_[point]; owner > unused) return owner;
    for (const Index cell : shared_point_cells_[shared_number(triangle[0])]) {
      const auto& points = mesh_.cells[cell];
      const auto on_cell = [&](GlobalIndex point) {
        return std::find(points.begin(), points.end(), point) != points.end();
      };
      if (on_cell(triangle[1]) && on_cell(triangle[2])) return owner_of(cell);
    }
    return unused;
  }

  void add_cell(Share& share, Index cell) {
    share.cell_ids.push_back(cell);
    auto& points = share.cell_points.emplace_back();
    for (std::size_t i = 0; i < 4; ++i) {
      const GlobalIndex id = mesh_.cells[cell][i];
      Index& local = local_point_[id];
      if (local < 0) {
        local = static_cast<Index>(share.point_ids.size());
        share.point_ids.push_back(id);
      }
      points[i] = local;
    }
  }

  const Mesh& mesh_;
  const std::vector<int>& owner_;
  std::vector<int> point_owner_;  // the one rank whose cells use a point, or `unused`, or below that: shared
  Index shared_points_ = 0;
  Adjacency shared_point_cells_;
  Adjacency rank_cells_, rank_triangles_;
  std::vector<const std::array<GlobalIndex, 3>*> triangles_;
  std::vector<Index> triangle_patch_;
  std::vector<Index> local_point_;  // of the share being cut; -1: not in it
};

constexpr int tag = 1;

/// Sends or receives every array of a share: its length, then its bytes in pieces that an int can count.
template <class Move>
void for_each_piece(Share& share, const Move& move) {
  const auto move_array = [&](auto& array) {
    GlobalIndex length = static_cast<GlobalIndex>(array.size());
    move(&length, sizeof(length));
    array.resize(static_cast<std::size_t>(length));  // changes nothing when sending
    const auto bytes = std::as_writable_bytes(std::span(array));
    constexpr std::size_t piece = std::size_t{1} << 30;
    for (std::size_t begin = 0; begin < bytes.size(); begin += piece)
      move(bytes.data() + begin, std::min(piece, bytes.size() - begin));
  };
  move_array(share.cell_ids);
  move_array(share.cell_points);
  move_array(share.ghost_owner);
  move_array(share.point_ids);
  move_array(share.points);
  move_array(share.triangles);
  move_array(share.triangle_ids);
  move_array(share.triangle_patch);
}

void send(Share& share, int rank, MPI_Comm comm) {
  for_each_piece(share, [&](void* data, std::size_t bytes) {
    MPI_Send(data, static_cast<int>(bytes), MPI_BYTE, rank, tag, comm);
  });
}

Share receive(int rank, MPI_Comm comm) {
  Share share;
  for_each_piece(share, [&](void* data, std::size_t bytes) {
    MPI_Recv(data, static_cast<int>(bytes), MPI_BYTE, rank, tag, comm, MPI_STATUS_IGNORE);
  });
  return share;
}

}  // namespace

Share scatter_shares(const Mesh& mesh, const std::vector<int>& owner, const Communicator& comm) {
  Share share;
  if (comm.is_root()) {
    Cutter cutter(mesh, owner, comm.size());
    for (int rank = 1; rank < comm.size(); ++rank) {
      Share theirs = cutter.cut(rank);
      send(theirs, rank, comm.handle());
    }
    share = cutter.cut(0);
  } else {
    share = receive(0, comm.handle());
  }

  std::array<GlobalIndex, 3> sizes{static_cast<GlobalIndex>(mesh.cells.size()),
                                   static_cast<GlobalIndex>(mesh.points.size()),
                                   static_cast<GlobalIndex>(mesh.patches.size())};
  comm.broadcast(std::as_writable_bytes(std::span(sizes)));
  share.global_cells = sizes[0];
  share.global_points = sizes[1];
  for (std::size_t i = 0; i < static_cast<std::size_t>(sizes[2]); ++i)
    share.patch_names.push_back(comm.broadcast(comm.is_root() ? mesh.patches[i].name : ""));
  return share;
}

}  // namespace alphadot
