// The unknowns: one primitive state a cell, with its halo.
#pragma once

#include <memory>
#include <vector>

#include "euler/state.hpp"
#include "partition/halo.hpp"

namespace alphadot {

/// Array of [total_cells] values of type V whose ghosts can be brought up to date.
template <class V>
class CellField {
 public:
  CellField(const Subdomain& domain, const Communicator& comm, HaloWidth width = HaloWidth::points)
      : values_(static_cast<std::size_t>(domain.total_cells)), halo_(domain, comm, values_, width) {}

  V& operator[](Index cell) { return values_[static_cast<std::size_t>(cell)]; }
  const V& operator[](Index cell) const { return values_[static_cast<std::size_t>(cell)]; }
  V* data() { return values_.data(); }
  const V* data() const { return values_.data(); }
  std::span<V> values() { return values_; }
  std::span<const V> values() const { return values_; }
  std::size_t bytes() const { return values_.size() * sizeof(V); }

  void start_exchange() { halo_.start(); }
  void finish_exchange() { halo_.wait(); }
  void exchange() {
    exchange([] {});
  }
  /// The same while `meanwhile` does what needs no ghost.
  template <class Work>
  void exchange(Work&& meanwhile) {
    start_exchange();
    meanwhile();
    finish_exchange();
  }
  const HaloExchange<V>& halo() const { return halo_; }

 private:
  std::vector<V> values_;
  HaloExchange<V> halo_;
};

template <class T>
using FlowField = CellField<Primitive<T>>;

}  // namespace alphadot
