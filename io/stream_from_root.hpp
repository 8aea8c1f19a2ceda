// The way back of stream_to_root: a long array read by the root piece by piece, each rank keeping its share.
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

/// Fills the `values` of all ranks, in the order of ranks, with what `produce(first, piece)` puts into pieces
/// of at most `largest_piece` values on the root; `first` counts the values before the piece. Collective.
/// When `produce` throws, it is not called again, and every rank throws InputError after the last message.
template <class T>
void stream_from_root(const Communicator& comm, std::span<T> values,
                      const std::function<void(GlobalIndex first, std::span<T> piece)>& produce,
                      GlobalIndex largest_piece = GlobalIndex{1} << 20) {
  static_assert(std::is_trivially_copyable_v<T>);
  constexpr int tag = 72;
  const auto size = static_cast<GlobalIndex>(values.size());
  std::vector<GlobalIndex> sizes(static_cast<std::size_t>(comm.is_root() ? comm.size() : 0));
  MPI_Gather(&size, 1, MPI_INT64_T, sizes.data(), 1, MPI_INT64_T, 0, comm.handle());

  const auto bytes = [](GlobalIndex count) {
    return static_cast<int>(count * static_cast<GlobalIndex>(sizeof(T)));
  };
  if (!comm.is_root()) {
    for (GlobalIndex begin = 0; begin < size; begin += largest_piece)
      MPI_Recv(values.data() + begin, bytes(std::min(largest_piece, size - begin)), MPI_BYTE, 0, tag,
               comm.handle(), MPI_STATUS_IGNORE);
  }
  std::exception_ptr failure;
  GlobalIndex first = 0;
  std::vector<T> sent;
  for (int rank = 0; rank < static_cast<int>(sizes.size()); ++rank) {
    const GlobalIndex rank_size = sizes[static_cast<std::size_t>(rank)];
    for (GlobalIndex begin = 0; begin < rank_size; begin += largest_piece) {
      const GlobalIndex count = std::min(largest_piece, rank_size - begin);
      if (rank > 0) sent.assign(static_cast<std::size_t>(count), T{});
      const auto piece =
          rank > 0 ? std::span<T>(sent)
                   : values.subspan(static_cast<std::size_t>(begin), static_cast<std::size_t>(count));
      try {
        if (!failure) produce(first, piece);
      } catch (...) {
        failure = std::current_exception();
      }
      if (rank > 0) MPI_Send(sent.data(), bytes(count), MPI_BYTE, rank, tag, comm.handle());
      first += count;
    }
  }
  comm.on_root([&] {
    if (failure) std::rethrow_exception(failure);
  });
}

}  // namespace alphadot
