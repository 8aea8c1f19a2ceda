// Exchange of ghost values: persistent requests, started and waited for separately so that work fits in
// between.
#pragma once

#include <mpi.h>

#include <cstddef>
#include <span>
#include <stdexcept>
#include <type_traits>
#include <vector>

#include "core/communicator.hpp"
#include "partition/subdomain.hpp"

namespace alphadot {

/// Which ghosts an exchange fills: all of them, or only those that share a face with an owned cell.
enum class HaloWidth { points, faces };

/// What exchanges have cost this rank so far.
struct HaloTraffic {
  Real wait_seconds = 0;
  GlobalIndex bytes = 0, messages = 0;  ///< sent

  friend HaloTraffic operator+(const HaloTraffic& a, const HaloTraffic& b) {
    return {a.wait_seconds + b.wait_seconds, a.bytes + b.bytes, a.messages + b.messages};
  }
};

/// Fills the ghosts of one array of cell values of `stride` bytes each. Bound to the array's address, and to
/// the domain's send lists, for life. Several exchanges may be under way at once; ranks must start them in
/// the same order.
class HaloExchangeBytes {
 public:
  HaloExchangeBytes(const Subdomain& domain, const Communicator& comm, HaloWidth width, std::byte* values,
                    std::size_t stride);
  ~HaloExchangeBytes();  ///< waits for an exchange that is under way
  HaloExchangeBytes(const HaloExchangeBytes&) = delete;
  HaloExchangeBytes& operator=(const HaloExchangeBytes&) = delete;

  void start();  ///< packs and sends the owned values that others need
  void wait();   ///< returns when the ghosts of this rank hold their owners' values
  HaloTraffic traffic() const { return traffic_; }
  std::size_t bytes_sent() const;  ///< each start() sends this many

 private:
  std::vector<std::vector<std::byte>> send_buffers_;
  std::vector<std::span<const Index>> send_cells_;
  std::vector<MPI_Request> requests_;
  const std::byte* values_;
  std::size_t stride_;
  HaloTraffic traffic_;
};

/// Typed front of HaloExchangeBytes for an array of [total_cells] values (or, with `components`, of
/// [total_cells * components] interleaved values). The array must not be reallocated afterwards.
template <class T>
class HaloExchange : public HaloExchangeBytes {
  static_assert(std::is_trivially_copyable_v<T>);

 public:
  HaloExchange(const Subdomain& domain, const Communicator& comm, std::span<T> values,
               HaloWidth width = HaloWidth::points)
      : HaloExchangeBytes(domain, comm, width, reinterpret_cast<std::byte*>(values.data()),
                          stride(values.size(), static_cast<std::size_t>(domain.total_cells))) {}
  void exchange() {
    start();
    wait();
  }

 private:
  static std::size_t stride(std::size_t values, std::size_t cells) {
    if (values == 0 || values % cells != 0)
      throw std::logic_error("a halo exchange needs a value for every local cell");
    return sizeof(T) * (values / cells);
  }
};

}  // namespace alphadot
