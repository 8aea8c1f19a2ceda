// The transpose of the exchange of ghost values: what ghosts hold is added to the values of their owners.
#pragma once

#include <mpi.h>

#include <cstddef>
#include <cstring>
#include <span>
#include <stdexcept>
#include <type_traits>
#include <vector>

#include "partition/halo.hpp"

namespace alphadot {

/// The transpose of HaloExchangeBytes: what ghosts hold travels to the buffers of their owners.
class ReverseHaloExchangeBytes {
 public:
  ReverseHaloExchangeBytes(const Subdomain& domain, const Communicator& comm, HaloWidth width,
                           const std::byte* values, std::size_t stride);
  ~ReverseHaloExchangeBytes();  ///< waits for an exchange that is under way
  ReverseHaloExchangeBytes(const ReverseHaloExchangeBytes&) = delete;
  ReverseHaloExchangeBytes& operator=(const ReverseHaloExchangeBytes&) = delete;

  void start();  ///< sends the values of the ghosts; these must stay as they are until wait()
  HaloTraffic traffic() const { return traffic_; }
  std::size_t bytes() const;  ///< of the buffers

 protected:
  /// What one neighbour's ghosts hold of these owned cells, once it has arrived.
  struct Part {
    std::span<const Index> cells;
    std::vector<std::byte> buffer;
  };
  void receive();  ///< waits for all parts
  std::span<const Part> parts() const { return parts_; }

 private:
  std::vector<Part> parts_;
  std::vector<MPI_Request> requests_;
  GlobalIndex sent_ = 0, messages_ = 0;  // by each start()
  HaloTraffic traffic_;
};

/// Adds the values of ghosts to those of their owners, for an array of [total_cells] values that must not be
/// reallocated afterwards. Adds in the order of the neighbours' ranks, so that sums are the same every time.
template <class T>
class ReverseHaloExchange : public ReverseHaloExchangeBytes {
  static_assert(std::is_trivially_copyable_v<T>);

 public:
  ReverseHaloExchange(const Subdomain& domain, const Communicator& comm, std::span<T> values,
                      HaloWidth width = HaloWidth::points)
      : ReverseHaloExchangeBytes(domain, comm, width, reinterpret_cast<const std::byte*>(values.data()),
                                 sizeof(T)),
        values_(values) {
    if (values.size() != static_cast<std::size_t>(domain.total_cells))
      throw std::logic_error("a halo exchange needs a value for every local cell");
  }

  /// Returns when the owned cells of this rank have got what their ghosts elsewhere held.
  void wait() {
    receive();
    for (const Part& part : parts()) {
      const std::byte* next = part.buffer.data();
      for (const Index cell : part.cells) {
        T value;
        std::memcpy(&value, next, sizeof(T));
        values_[static_cast<std::size_t>(cell)] += value;
        next += sizeof(T);
      }
    }
  }
  void exchange() {
    exchange([] {});
  }
  /// The same while `meanwhile` works on cells that are no ghosts elsewhere.
  template <class Work>
  void exchange(Work&& meanwhile) {
    start();
    meanwhile();
    wait();
  }

 private:
  std::span<T> values_;
};

}  // namespace alphadot
