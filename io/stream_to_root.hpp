// Bringing a distributed array to the root piece by piece, so that no rank ever holds it whole.
#pragma once

#include <functional>
#include <span>
#include <type_traits>
#include <vector>

#include "io/pieces.hpp"

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
  std::vector<T> received;
  const auto take = [&](const Piece& piece, const auto& attempt) {
    auto part = values.subspan(0, 0);
    if (piece.rank == 0) {
      part = values.subspan(static_cast<std::size_t>(piece.begin), static_cast<std::size_t>(piece.count));
    } else {
      received.resize(static_cast<std::size_t>(piece.count));
      MPI_Recv(received.data(), message_bytes<T>(piece.count), MPI_BYTE, piece.rank, tag, comm.handle(),
               MPI_STATUS_IGNORE);
      part = received;
    }
    attempt([&] { consume(piece.first, part); });
  };
  const auto give = [&](const Piece& piece) {
    MPI_Send(values.data() + piece.begin, message_bytes<T>(piece.count), MPI_BYTE, 0, tag, comm.handle());
  };
  walk_pieces(comm, static_cast<GlobalIndex>(values.size()), largest_piece, take, give);
}

}  // namespace alphadot
