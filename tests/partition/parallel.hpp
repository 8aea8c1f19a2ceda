// What the parallel tests of this folder share.
#pragma once

#include <mpi.h>

#include <random>
#include <vector>

#include "core/communicator.hpp"
#include "partition/mesh.hpp"
#include "support/box_mesh.hpp"

namespace alphadot::testing_support {

/// The values of all ranks, in the order of the ranks, on every rank.
inline std::vector<GlobalIndex> gather(const std::vector<GlobalIndex>& mine, const Communicator& comm) {
  std::vector<int> counts(static_cast<std::size_t>(comm.size())), begins(counts.size(), 0);
  const int count = static_cast<int>(mine.size());
  MPI_Allgather(&count, 1, MPI_INT, counts.data(), 1, MPI_INT, comm.handle());
  for (std::size_t i = 1; i < counts.size(); ++i) begins[i] = begins[i - 1] + counts[i - 1];
  std::vector<GlobalIndex> all(static_cast<std::size_t>(begins.back() + counts.back()));
  MPI_Allgatherv(mine.data(), count, MPI_INT64_T, all.data(), counts.data(), begins.data(), MPI_INT64_T,
                 comm.handle());
  return all;
}

/// An owner drawn for each cell: the most ghosts, parts in many pieces, ranks that share points but no faces.
inline std::vector<int> random_owners(const Mesh& mesh, int ranks) {
  std::mt19937 generator(5);
  std::vector<int> owner(mesh.cells.size());
  for (int& rank : owner) rank = static_cast<int>(generator() % static_cast<unsigned>(ranks));
  return owner;
}

/// A perturbed box of unequal sides and 6 * 7 * 5 * 4 cells.
inline Mesh test_box() {
  return box_mesh({.cells = {7, 5, 4}, .lower = {-1, 0, 2}, .upper = {2.5, 1.2, 3}, .perturbation = 0.12});
}

}  // namespace alphadot::testing_support
