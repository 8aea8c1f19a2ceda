// Bringing a distributed array to the root piece by piece, so that no rank ever holds it whole.
#pragma once

#include <algorithm>
#include <exception>
#include <functional>
#include <span>
#include <type_traits>
#include <vector>

#include "core/communicator.hpp"
#include "core/types.hpp"

namespace alphadot {

/// Hands the values of all ranks, in the order of ranks, to `consume(first, values)` on the root, in pieces
/// of at most `largest_piece` values; `first` counts the values before the piece. Collective. When `consume`
/// throws, the rest is received and dropped, so that no rank waits for another, and every rank throws
/// InputError. Cost: each value crosses the network once; the root holds one piece.
template <class T>
void stream_to_root(const Communicator& comm, std::span<const T> values,
                    const std::function<void(GlobalIndex first, std::span<const T> piece)>& consume,
                    GlobalIndex largest_piece = GlobalIndex{1} << 20) {
  static_assert(std::is_trivially_copyable_v<T>);
  constexpr int tag = 71;
  const auto size = static_cast<GlobalIndex>(values.size());
  std::vector<GlobalIndex> sizes(static_cast<std::size_t>(comm.is_root() ? comm.size() : 0));
  MPI_Gather(&size, 1, MPI_INT64_T, sizes.data(), 1, MPI_INT64_T, 0, comm.handle());

  const auto bytes = [](GlobalIndex count) {
    return static_cast<int>(count * static_cast<GlobalIndex>(sizeof(T)));
  };
  if (!comm.is_root()) {
    for (GlobalIndex begin = 0; begin < size; begin += largest_piece)
      MPI_Send(values.data() + begin, bytes(std::min(largest_piece, size - begin)), MPI_BYTE, 0, tag,
               comm.handle());
  }
  std::exception_ptr failure;
  GlobalIndex first = 0;
  std::vector<T> received;
  for (int rank = 0; rank < static_cast<int>(sizes.size()); ++rank) {
    const GlobalIndex rank_size = sizes[static_cast<std::size_t>(rank)];
    for (GlobalIndex begin = 0; begin < rank_size; begin += largest_piece) {
      const GlobalIndex count = std::min(largest_piece, rank_size - begin);
      auto piece = values.subspan(0, 0);
      if (rank == 0) {
        piece = values.subspan(static_cast<std::size_t>(begin), static_cast<std::size_t>(count));
      } else {
        received.resize(static_cast<std::size_t>(count));
        MPI_Recv(received.data(), bytes(count), MPI_BYTE, rank, tag, comm.handle(), MPI_STATUS_IGNORE);
        piece = received;
      }
      try {
        if (!failure) consume(first, piece);
      } catch (...) {
        failure = std::current_exception();
      }
      first += count;
    }
  }
  comm.on_root([&] {
    if (failure) std::rethrow_exception(failure);
  });
}

}  // namespace alphadot
