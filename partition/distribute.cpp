#include <algorithm>
#include <cstddef>
#include <string>
#include <utility>

#include "core/error.hpp"
#include "partition/build_subdomain.hpp"
#include "partition/decompose.hpp"
#include "partition/face_matching.hpp"
#include "partition/rank_mesh.hpp"
#include "partition/subdomain.hpp"

namespace alphadot {

namespace {

void check_owners(const Mesh& mesh, const std::vector<int>& owner, int ranks) {
  if (owner.size() != mesh.cells.size())
    throw InputError(mesh.file, 0,
                     std::to_string(owner.size()) + " owners are given for " +
                         std::to_string(mesh.cells.size()) + " cells",
                     "give one owner a cell");
  std::vector<char> used(static_cast<std::size_t>(ranks), 0);
  for (const int rank : owner) {
    if (rank < 0 || rank >= ranks)
      throw InputError(mesh.file, 0,
                       "a cell is owned by rank " + std::to_string(rank) + " of " + std::to_string(ranks),
                       "run on as many ranks as the partition was made for");
    used[rank] = 1;
  }
  if (const auto empty = std::find(used.begin(), used.end(), 0); empty != used.end())
    throw InputError(mesh.file, 0, "rank " + std::to_string(empty - used.begin()) + " owns no cell",
                     "run on as many ranks as the partition was made for");
}

}  // namespace

Subdomain distribute(const Mesh& mesh, const Communicator& comm, Real scale) {
  std::vector<int> owner;
  comm.on_root([&] { owner = decompose(mesh, comm.size()); });
  return distribute(mesh, owner, comm, scale);
}

Subdomain distribute(const Mesh& mesh, const std::vector<int>& owner, const Communicator& comm, Real scale) {
  comm.on_root([&] { check_owners(mesh, owner, comm.size()); });
  return distribute(scatter(mesh, owner, comm), comm, scale);
}

Subdomain distribute(MeshPart part, const Communicator& comm, Real scale) {
  comm.on_all([&] {
    if (static_cast<GlobalIndex>(std::max(part.cells.size(), part.points.size())) > max_cells_for_faces)
      throw InputError(part.file, 0,
                       "rank " + std::to_string(comm.rank()) + " would hold " +
                           std::to_string(part.cells.size()) + " cells, of at most " +
                           std::to_string(max_cells_for_faces),
                       "use more ranks");
  });
  RankMesh rank_mesh = gather_rank_mesh(std::move(part), comm);
  Subdomain domain;
  comm.on_all([&] { domain = build_subdomain(std::move(rank_mesh), scale); });
  return domain;
}

}  // namespace alphadot
