// Items that ranks send each other, every rank to every other one at once.
#pragma once

#include <mpi.h>

#include <algorithm>
#include <cstddef>
#include <limits>
#include <numeric>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include "core/communicator.hpp"
#include "core/error.hpp"
#include "core/types.hpp"

namespace alphadot {

/// What arrived: the items of rank 0, then those of rank 1, ...
template <class T>
struct Delivery {
  std::vector<T> items;
  std::vector<int> counts;  ///< [ranks] from each rank

  /// The rank that sent each item.
  std::vector<int> senders() const {
    std::vector<int> out;
    out.reserve(items.size());
    for (std::size_t rank = 0; rank < counts.size(); ++rank)
      out.insert(out.end(), static_cast<std::size_t>(counts[rank]), static_cast<int>(rank));
    return out;
  }
};

/// A number of items as MPI counts them; too many for it stand as the largest, which is refused.
inline int item_count(std::size_t items) {
  return static_cast<int>(std::min<std::size_t>(items, std::numeric_limits<int>::max()));
}

/// Throws InputError on every rank when the counts of one make more items than MPI counts, nearly 2^31.
/// Collective.
inline void check_deliverable(const std::vector<int>& counts, const Communicator& comm) {
  comm.on_all([&] {
    const auto items = std::accumulate(counts.begin(), counts.end(), GlobalIndex{0});
    if (items >= std::numeric_limits<int>::max())
      throw InputError("", 0,
                       "rank " + std::to_string(comm.rank()) + " has more items to exchange (" +
                           std::to_string(items) + ") than MPI counts",
                       "use more ranks");
  });
}

/// Sends the first counts[0] of `items` to rank 0, the next counts[1] to rank 1, ... One all-to-all of the
/// counts and one of the items; at most 2^31 items each way (InputError). Collective.
template <class T>
Delivery<T> deliver(std::span<const T> items, const std::vector<int>& counts, const Communicator& comm) {
  static_assert(std::is_trivially_copyable_v<T>);
  const auto ranks = static_cast<std::size_t>(comm.size());
  Delivery<T> out;
  out.counts.resize(ranks);
  check_deliverable(counts, comm);
  MPI_Alltoall(counts.data(), 1, MPI_INT, out.counts.data(), 1, MPI_INT, comm.handle());
  check_deliverable(out.counts, comm);
  std::vector<int> sent_begin(ranks), begin(ranks);
  std::exclusive_scan(counts.begin(), counts.end(), sent_begin.begin(), 0);
  std::exclusive_scan(out.counts.begin(), out.counts.end(), begin.begin(), 0);
  out.items.resize(static_cast<std::size_t>(begin.back()) + static_cast<std::size_t>(out.counts.back()));
  const ByteItem item(sizeof(T));
  MPI_Alltoallv(items.data(), counts.data(), sent_begin.data(), item.type(), out.items.data(),
                out.counts.data(), begin.data(), item.type(), comm.handle());
  return out;
}

/// Positions of items in the order of the ranks that they go to, and how many go to each.
struct Addressed {
  std::vector<Index> order;
  std::vector<int> counts;
};

/// `rank_of(i)`: where item i goes. Items to one rank keep their order.
template <class RankOf>
Addressed address(std::size_t items, const RankOf& rank_of, const Communicator& comm) {
  Addressed out;
  out.counts.assign(static_cast<std::size_t>(comm.size()), 0);
  for (std::size_t i = 0; i < items; ++i) ++out.counts[static_cast<std::size_t>(rank_of(i))];
  std::vector<int> next(out.counts.size());
  std::exclusive_scan(out.counts.begin(), out.counts.end(), next.begin(), 0);
  out.order.resize(items);
  for (std::size_t i = 0; i < items; ++i)
    out.order[static_cast<std::size_t>(next[static_cast<std::size_t>(rank_of(i))]++)] = static_cast<Index>(i);
  return out;
}

/// Sends each of `items` to the rank that `rank_of(item)` names. Collective.
template <class T, class RankOf>
Delivery<T> deliver_to(std::span<const T> items, const RankOf& rank_of, const Communicator& comm) {
  check_deliverable({item_count(items.size())}, comm);
  const auto addressed = address(
      items.size(), [&](std::size_t i) { return rank_of(items[i]); }, comm);
  std::vector<T> sent;
  sent.reserve(items.size());
  for (const Index i : addressed.order) sent.push_back(items[static_cast<std::size_t>(i)]);
  return deliver<T>(sent, addressed.counts, comm);
}

}  // namespace alphadot
