#include "partition/slabs.hpp"

#include <numeric>

namespace alphadot {

void Slabs::Layout::set_begins() {
  begins.resize(counts.size());
  std::exclusive_scan(counts.begin(), counts.end(), begins.begin(), 0);
}

Slabs::Slabs(std::span<const GlobalIndex> ids, GlobalIndex total, const Communicator& comm)
    : comm_(comm), total_(total), order_(ids.size()) {
  const auto ranks = static_cast<std::size_t>(comm.size());
  const GlobalIndex share = std::max<GlobalIndex>(1, (total + comm.size() - 1) / comm.size());
  begin_ = std::min(total, share * comm.rank());
  size_ = std::min(total, begin_ + share) - begin_;

  user_.counts.assign(ranks, 0);
  for (const GlobalIndex id : ids) ++user_.counts[static_cast<std::size_t>(id / share)];
  user_.set_begins();
  auto next = user_.begins;
  for (std::size_t i = 0; i < ids.size(); ++i)
    order_[static_cast<std::size_t>(next[static_cast<std::size_t>(ids[i] / share)]++)] =
        static_cast<Index>(i);

  holder_.counts.resize(ranks);
  MPI_Alltoall(user_.counts.data(), 1, MPI_INT, holder_.counts.data(), 1, MPI_INT, comm.handle());
  holder_.set_begins();

  std::vector<GlobalIndex> sent(ids.size()), received(holder_.size());
  for (std::size_t i = 0; i < sent.size(); ++i) sent[i] = ids[static_cast<std::size_t>(order_[i])];
  exchange(sent, user_, received, holder_);
  slab_rows_.resize(received.size());
  for (std::size_t i = 0; i < received.size(); ++i) slab_rows_[i] = static_cast<Index>(received[i] - begin_);
}

}  // namespace alphadot
