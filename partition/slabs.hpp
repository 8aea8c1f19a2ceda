// Between the order of a rank's partition and the order of the mesh file, which no number of ranks changes.
#pragma once

#include <algorithm>
#include <span>
#include <type_traits>
#include <vector>

#include "core/communicator.hpp"
#include "core/types.hpp"

namespace alphadot {

/// Rank r's slab is the r-th equal share of the global ids [0, total): slabs one after the other are the
/// order of the mesh file. Moves values between the ranks that use an id and the slab that holds it, with one
/// all-to-all each way. Several ranks may use one id: they must then send the same value.
class Slabs {
 public:
  /// Collective. `ids` are those that this rank uses, each in [0, total).
  Slabs(std::span<const GlobalIndex> ids, GlobalIndex total, const Communicator& comm);

  GlobalIndex total() const { return total_; }
  GlobalIndex begin() const { return begin_; }  ///< first id of this rank's slab
  GlobalIndex size() const { return size_; }    ///< of this rank's slab

  /// values[i] belongs to ids[i]; returns the values of this rank's slab. Collective.
  template <class T>
  std::vector<T> to_slab(std::span<const T> values) const {
    std::vector<T> sent(order_.size()), received(slab_rows_.size()), slab(static_cast<std::size_t>(size_));
    for (std::size_t i = 0; i < sent.size(); ++i) sent[i] = values[static_cast<std::size_t>(order_[i])];
    exchange<T>(sent, user_, received, holder_);
    for (std::size_t i = 0; i < received.size(); ++i)
      slab[static_cast<std::size_t>(slab_rows_[i])] = received[i];
    return slab;
  }

  /// The way back: fills values[i] with what the slabs hold for ids[i]. Collective.
  template <class T>
  void from_slab(std::span<const T> slab, std::span<T> values) const {
    std::vector<T> sent(slab_rows_.size()), received(order_.size());
    for (std::size_t i = 0; i < sent.size(); ++i) sent[i] = slab[static_cast<std::size_t>(slab_rows_[i])];
    exchange<T>(sent, holder_, received, user_);
    for (std::size_t i = 0; i < received.size(); ++i)
      values[static_cast<std::size_t>(order_[i])] = received[i];
  }

 private:
  /// How many values go to or come from each rank, and where they begin.
  struct Layout {
    std::vector<int> counts, begins;
    void set_begins();
    std::size_t size() const { return static_cast<std::size_t>(begins.back() + counts.back()); }
  };

  template <class T>
  void exchange(const std::vector<T>& sent, const Layout& send, std::vector<T>& received,
                const Layout& receive) const {
    static_assert(std::is_trivially_copyable_v<T>);
    MPI_Datatype value;
    MPI_Type_contiguous(sizeof(T), MPI_BYTE, &value);
    MPI_Type_commit(&value);
    MPI_Alltoallv(sent.data(), send.counts.data(), send.begins.data(), value, received.data(),
                  receive.counts.data(), receive.begins.data(), value, comm_.handle());
    MPI_Type_free(&value);
  }

  Communicator comm_;
  GlobalIndex total_, begin_, size_;
  std::vector<Index> order_;      ///< this rank's ids sorted by the slab that holds them: positions in `ids`
  std::vector<Index> slab_rows_;  ///< rows of this rank's slab in the order in which their values arrive
  Layout user_, holder_;          ///< of this rank as a user of ids, and as the holder of a slab
};

}  // namespace alphadot
