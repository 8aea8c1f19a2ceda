// The way back of stream_to_root: a long array read by the root piece by piece, each rank keeping its share.
#pragma once

#include <functional>
#include <span>
#include <type_traits>
#include <vector>

#include "io/pieces.hpp"

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
  std::vector<T> sent;
  const auto give = [&](const Piece& piece, const auto& attempt) {
    const auto count = static_cast<std::size_t>(piece.count);
    if (piece.rank == 0) {
      attempt([&] { produce(piece.first, values.subspan(static_cast<std::size_t>(piece.begin), count)); });
      return;
    }
    sent.assign(count, T{});
    attempt([&] { produce(piece.first, sent); });
    MPI_Send(sent.data(), message_bytes<T>(piece.count), MPI_BYTE, piece.rank, tag, comm.handle());
  };
  const auto take = [&](const Piece& piece) {
    MPI_Recv(values.data() + piece.begin, message_bytes<T>(piece.count), MPI_BYTE, 0, tag, comm.handle(),
             MPI_STATUS_IGNORE);
  };
  walk_pieces(comm, static_cast<GlobalIndex>(values.size()), largest_piece, give, take);
}

}  // namespace alphadot
