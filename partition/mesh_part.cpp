#include "partition/mesh_part.hpp"

#include <mpi.h>

#include <algorithm>
#include <cstddef>
#include <span>

#include "partition/adjacency.hpp"
#include "partition/face_matching.hpp"
#include "partition/slabs.hpp"

namespace alphadot {

namespace {

/// Cuts parts out of the mesh. Holds 4 bytes a cell and 48 a boundary triangle.
class Cutter {
 public:
  Cutter(const Mesh& mesh, const std::vector<int>& owner, int ranks)
      : mesh_(mesh),
        point_slabs_(static_cast<GlobalIndex>(mesh.points.size()), ranks),
        rank_cells_(collect_rows(ranks, static_cast<Index>(mesh.cells.size()),
                                 [&](Index cell) { return std::array{owner[cell]}; })) {
    for (std::size_t patch = 0; patch < mesh.patches.size(); ++patch)
      for (const auto& points : mesh.patches[patch].triangles)
        triangles_.push_back(
            {points, static_cast<GlobalIndex>(triangles_.size()), static_cast<GlobalIndex>(patch)});
    std::vector<int> triangle_owner(triangles_.size(), 0);
    find_owners(owner, triangle_owner);
    rank_triangles_ = collect_rows(ranks, static_cast<Index>(triangles_.size()),
                                   [&](Index triangle) { return std::array{triangle_owner[triangle]}; });
  }

  MeshPart cut(int rank) const {
    MeshPart part;
    for (const Index cell : rank_cells_[rank]) {
      part.cell_ids.push_back(cell);
      part.cells.push_back(mesh_.cells[cell]);
    }
    for (const Index triangle : rank_triangles_[rank]) part.triangles.push_back(triangles_[triangle]);
    part.points.assign(mesh_.points.begin() + point_slabs_.begin(rank),
                       mesh_.points.begin() + point_slabs_.end(rank));
    return part;
  }

 private:
  /// Of every triangle: the owner of the cell behind it.
  void find_owners(const std::vector<int>& owner, std::vector<int>& triangle_owner) const {
    std::vector<std::array<GlobalIndex, 3>> points;
    for (const auto& triangle : triangles_) points.push_back(triangle.points);
    const auto cell_sides = static_cast<Index>(4 * mesh_.cells.size());
    for_each_face<GlobalIndex>(mesh_.cells, points, mesh_.points.size(), [&](std::span<const Index> sides) {
      if (sides.front() < cell_sides && sides.back() >= cell_sides)
        triangle_owner[sides.back() - cell_sides] = owner[sides.front() / 4];
    });
  }

  const Mesh& mesh_;
  EqualSlabs point_slabs_;
  Adjacency rank_cells_, rank_triangles_;
  std::vector<BoundaryTriangle> triangles_;
};

constexpr int tag = 1;

/// Sends or receives every array of a part: its length, then its bytes in pieces that an int can count.
template <class Move>
void for_each_piece(MeshPart& part, const Move& move) {
  const auto move_array = [&](auto& array) {
    GlobalIndex length = static_cast<GlobalIndex>(array.size());
    move(&length, sizeof(length));
    array.resize(static_cast<std::size_t>(length));  // changes nothing when sending
    const auto bytes = std::as_writable_bytes(std::span(array));
    constexpr std::size_t piece = std::size_t{1} << 30;
    for (std::size_t begin = 0; begin < bytes.size(); begin += piece)
      move(bytes.data() + begin, std::min(piece, bytes.size() - begin));
  };
  move_array(part.cell_ids);
  move_array(part.cells);
  move_array(part.triangles);
  move_array(part.points);
}

void send(MeshPart& part, int rank, MPI_Comm comm) {
  for_each_piece(part, [&](void* data, std::size_t bytes) {
    MPI_Send(data, static_cast<int>(bytes), MPI_BYTE, rank, tag, comm);
  });
}

MeshPart receive(int rank, MPI_Comm comm) {
  MeshPart part;
  for_each_piece(part, [&](void* data, std::size_t bytes) {
    MPI_Recv(data, static_cast<int>(bytes), MPI_BYTE, rank, tag, comm, MPI_STATUS_IGNORE);
  });
  return part;
}

}  // namespace

MeshPart scatter(const Mesh& mesh, const std::vector<int>& owner, const Communicator& comm) {
  MeshPart part;
  if (comm.is_root()) {
    const Cutter cutter(mesh, owner, comm.size());
    for (int rank = 1; rank < comm.size(); ++rank) {
      MeshPart theirs = cutter.cut(rank);
      send(theirs, rank, comm.handle());
    }
    part = cutter.cut(0);
    part.global_cells = static_cast<GlobalIndex>(mesh.cells.size());
    part.global_points = static_cast<GlobalIndex>(mesh.points.size());
    for (const auto& patch : mesh.patches) {
      part.global_triangles += static_cast<GlobalIndex>(patch.triangles.size());
      part.patch_names.push_back(patch.name);
    }
  } else {
    part = receive(0, comm.handle());
  }
  std::array sizes{part.global_cells, part.global_points, part.global_triangles,
                   static_cast<GlobalIndex>(part.patch_names.size())};
  comm.broadcast(std::as_writable_bytes(std::span(sizes)));
  part.global_cells = sizes[0];
  part.global_points = sizes[1];
  part.global_triangles = sizes[2];
  part.patch_names.resize(static_cast<std::size_t>(sizes[3]));
  for (auto& name : part.patch_names) name = comm.broadcast(name);
  part.file = comm.broadcast(mesh.file);
  return part;
}

}  // namespace alphadot
