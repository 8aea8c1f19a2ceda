#include "partition/slabs.hpp"

#include <array>
#include <utility>

#include "partition/adjacency.hpp"

namespace alphadot {

Slabs::Slabs(std::span<const GlobalIndex> ids, GlobalIndex total, const Communicator& comm)
    : comm_(comm), slabs_(total, comm.size()) {
  auto addressed = address(
      ids.size(), [&](std::size_t i) { return slabs_.rank_of(ids[i]); }, comm);
  user_order_ = std::move(addressed.order);
  user_counts_ = std::move(addressed.counts);
  std::vector<GlobalIndex> sent(ids.size());
  for (std::size_t i = 0; i < sent.size(); ++i) sent[i] = ids[static_cast<std::size_t>(user_order_[i])];
  const auto received = deliver<GlobalIndex>(sent, user_counts_, comm);
  holder_counts_ = received.counts;
  slab_rows_.resize(received.items.size());
  for (std::size_t i = 0; i < received.items.size(); ++i)
    slab_rows_[i] = static_cast<Index>(received.items[i] - begin());
}

std::vector<Slabs::Sharing> Slabs::sharings() const {
  // The holder of an id tells each of its users who the others are; it names the id by its place in the
  // user's message.
  std::vector<int> user(slab_rows_.size());
  std::vector<Index> place(slab_rows_.size());
  std::size_t next = 0;
  for (std::size_t rank = 0; rank < holder_counts_.size(); ++rank)
    for (Index i = 0; i < holder_counts_[rank]; ++i, ++next) {
      user[next] = static_cast<int>(rank);
      place[next] = i;
    }
  const Adjacency row_uses =
      collect_rows(static_cast<Index>(size()), static_cast<Index>(slab_rows_.size()),
                   [&](Index use) { return std::array{slab_rows_[static_cast<std::size_t>(use)]}; });
  struct Notice {
    Sharing sharing;
    int to;
  };
  std::vector<Notice> notices;
  for (Index row = 0; row < row_uses.rows(); ++row)
    for (const Index a : row_uses[row])
      for (const Index b : row_uses[row])
        if (a != b)
          notices.push_back({{place[static_cast<std::size_t>(a)], user[static_cast<std::size_t>(b)]},
                             user[static_cast<std::size_t>(a)]});
  const auto received = deliver_to<Notice>(
      notices, [](const Notice& notice) { return notice.to; }, comm_);

  std::vector<Sharing> out;
  out.reserve(received.items.size());
  std::size_t item = 0;
  Index begin_of_holder = 0;
  for (std::size_t holder = 0; holder < received.counts.size(); ++holder) {
    for (int i = 0; i < received.counts[holder]; ++i) {
      const Sharing& sharing = received.items[item++].sharing;
      out.push_back(
          {user_order_[static_cast<std::size_t>(begin_of_holder + sharing.position)], sharing.rank});
    }
    begin_of_holder += user_counts_[holder];
  }
  return out;
}

}  // namespace alphadot
