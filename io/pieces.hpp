// The walk over the values of all ranks, piece by piece, that brings them to the root and back.
#pragma once

#include <algorithm>
#include <exception>
#include <vector>

#include "core/communicator.hpp"
#include "core/types.hpp"

namespace alphadot {

/// A piece of the values of one rank: `begin` counts its values before the piece, `first` those of all ranks.
struct Piece {
  int rank;
  GlobalIndex first, begin, count;
};

/// Visits the pieces, of at most `largest_piece` values, that `size` values on each rank make, in the order
/// of ranks. On the root `on_root(piece, attempt)` sees the pieces of all ranks, its own included;
/// `attempt(work)` runs what may throw, and after a failure nothing, so that no message is left out. On the
/// other ranks `on_others(piece)` sees their own (first = begin). Collective; after a failure every rank
/// throws InputError at the end.
template <class OnRoot, class OnOthers>
void walk_pieces(const Communicator& comm, GlobalIndex size, GlobalIndex largest_piece, OnRoot on_root,
                 OnOthers on_others) {
  std::vector<GlobalIndex> sizes(static_cast<std::size_t>(comm.is_root() ? comm.size() : 0));
  MPI_Gather(&size, 1, MPI_INT64_T, sizes.data(), 1, MPI_INT64_T, 0, comm.handle());

  const auto for_each_piece = [&](int rank, GlobalIndex before, GlobalIndex rank_size, auto&& visit) {
    for (GlobalIndex begin = 0; begin < rank_size; begin += largest_piece)
      visit(Piece{rank, before + begin, begin, std::min(largest_piece, rank_size - begin)});
  };
  if (!comm.is_root()) for_each_piece(comm.rank(), 0, size, on_others);

  std::exception_ptr failure;
  const auto attempt = [&](auto&& work) {
    if (failure) return;
    try {
      work();
    } catch (...) {
      failure = std::current_exception();
    }
  };
  GlobalIndex before = 0;
  for (int rank = 0; rank < static_cast<int>(sizes.size()); ++rank) {
    const GlobalIndex rank_size = sizes[static_cast<std::size_t>(rank)];
    for_each_piece(rank, before, rank_size, [&](const Piece& piece) { on_root(piece, attempt); });
    before += rank_size;
  }
  comm.on_root([&] {
    if (failure) std::rethrow_exception(failure);
  });
}

/// Bytes of `count` values, for a message.
template <class T>
int message_bytes(GlobalIndex count) {
  return static_cast<int>(count * static_cast<GlobalIndex>(sizeof(T)));
}

}  // namespace alphadot
