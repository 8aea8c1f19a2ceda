// Between the order of a rank's partition and the order of the mesh file, which no number of ranks changes.
#pragma once

#include <algorithm>
#include <span>
#include <vector>

#include "core/communicator.hpp"
#include "core/types.hpp"
#include "partition/delivery.hpp"

namespace alphadot {

/// Ids [0, total) in equal consecutive slabs, the last ones perhaps shorter: rank r holds [begin(r),
/// end(r)).
struct EqualSlabs {
  EqualSlabs(GlobalIndex total_ids, int ranks)
      : total(total_ids), slab(std::max<GlobalIndex>(1, (total_ids + ranks - 1) / ranks)) {}
  int rank_of(GlobalIndex id) const { return static_cast<int>(id / slab); }
  GlobalIndex begin(int rank) const { return std::min(total, slab * rank); }
  GlobalIndex end(int rank) const { return begin(rank + 1); }
  GlobalIndex size(int rank) const { return end(rank) - begin(rank); }

  GlobalIndex total, slab;
};

/// Rank r's slab is the r-th equal part of the global ids [0, total): slabs one after the other are the
/// order of the mesh file. Moves values between the ranks that use an id and the slab that holds it, with one
/// all-to-all each way. Several ranks may use one id: they must then send the same value.
class Slabs {
 public:
  /// Collective. `ids` are those that this rank uses, each in [0, total).
  Slabs(std::span<const GlobalIndex> ids, GlobalIndex total, const Communicator& comm);

  GlobalIndex total() const { return slabs_.total; }
  GlobalIndex begin() const { return slabs_.begin(comm_.rank()); }  ///< first id of this rank's slab
  GlobalIndex size() const { return slabs_.size(comm_.rank()); }    ///< of this rank's slab

  /// values[i] belongs to ids[i]; returns the values of this rank's slab. Collective.
  template <class T>
  std::vector<T> to_slab(std::span<const T> values) const {
    std::vector<T> sent(user_order_.size()), slab(static_cast<std::size_t>(size()));
    for (std::size_t i = 0; i < sent.size(); ++i) sent[i] = values[static_cast<std::size_t>(user_order_[i])];
    const auto received = deliver<T>(sent, user_counts_, comm_).items;
    for (std::size_t i = 0; i < received.size(); ++i)
      slab[static_cast<std::size_t>(slab_rows_[i])] = received[i];
    return slab;
  }

  /// The way back: fills values[i] with what the slabs hold for ids[i]. Collective.
  template <class T>
  void from_slab(std::span<const T> slab, std::span<T> values) const {
    std::vector<T> sent(slab_rows_.size());
    for (std::size_t i = 0; i < sent.size(); ++i) sent[i] = slab[static_cast<std::size_t>(slab_rows_[i])];
    const auto received = deliver<T>(sent, holder_counts_, comm_).items;
    for (std::size_t i = 0; i < received.size(); ++i)
      values[static_cast<std::size_t>(user_order_[i])] = received[i];
  }

  /// One of this rank's ids that another rank uses too.
  struct Sharing {
    Index position;  ///< in `ids`
    int rank;        ///< the other one
  };
  /// All of them. Collective.
  std::vector<Sharing> sharings() const;

 private:
  Communicator comm_;
  EqualSlabs slabs_;
  std::vector<Index> user_order_;  ///< this rank's ids in the order of the slabs that hold them: positions
  std::vector<Index> slab_rows_;   ///< rows of this rank's slab in the order in which their values arrive
  std::vector<int> user_counts_, holder_counts_;  ///< values to each holder, values from each user
};

}  // namespace alphadot
